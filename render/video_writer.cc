#include "sidestep/render/video_writer.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/imgutils.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <stdexcept>

#include "sidestep/core/atomic_file.h"
#include "sidestep/core/input_error.h"

namespace sidestep::render {
// What an encoder is made of.
namespace encoder {

struct AvDeleter {
  void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
  void operator()(AVFormatContext* format) const { avformat_free_context(format); }
  void operator()(AVIOContext* io) const {
    av_freep(&io->buffer);
    avio_context_free(&io);
  }
};
template <typename T>
using AvPtr = std::unique_ptr<T, AvDeleter>;

// What libavformat writes goes into our own file and nowhere else: given a name, it would take
// `file:x.mp4` or `http://x.mp4` for a protocol and `2026-11-27T10:15:00.mp4` for an unknown one.
struct Output {
  AtomicFile file;
  std::exception_ptr error;  // libavformat is C: what was thrown waits here
};

// A place in the output; the muxer opens a second one to move the index to the front.
struct Cursor {
  Output& output;
  std::int64_t position = 0;

  // Runs what may throw; a negative result tells libavformat that it failed.
  template <typename Action>
  int Try(const Action& action) {
    try {
      const int count = action();
      position += count;
      return count;
    } catch (...) {
      output.error = std::current_exception();
      return AVERROR(EIO);
    }
  }
};

}  // namespace encoder

namespace {

using encoder::AvDeleter;
using encoder::AvPtr;
using encoder::Cursor;
using encoder::Output;

std::string AvError(int code) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text = {};
  av_strerror(code, text.data(), text.size());
  return text.data();
}

void Check(int code, const std::string& path) {
  if (code < 0) throw InputError(path, "cannot be written: " + AvError(code));
}

AvPtr<AVFrame> MakeFrame(AVPixelFormat format, int width, int height) {
  AvPtr<AVFrame> frame(av_frame_alloc());
  if (!frame) throw std::bad_alloc();
  frame->format = format;
  frame->width = width;
  frame->height = height;
  if (av_frame_get_buffer(frame.get(), 0) < 0) throw std::bad_alloc();
  return frame;
}

int ReadSome(void* cursor, std::uint8_t* bytes, int size) {
  Cursor& from = *static_cast<Cursor*>(cursor);
  const int count = from.Try([&] {
    return static_cast<int>(from.output.file.ReadAt(static_cast<std::uint64_t>(from.position),
                                                    reinterpret_cast<char*>(bytes),
                                                    static_cast<std::size_t>(size)));
  });
  return count == 0 ? AVERROR_EOF : count;
}

int WriteSome(void* cursor, std::uint8_t* bytes, int size) {
  Cursor& to = *static_cast<Cursor*>(cursor);
  return to.Try([&] {
    to.output.file.WriteAt(static_cast<std::uint64_t>(to.position),
                           {reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size)});
    return size;
  });
}

std::int64_t Seek(void* cursor, std::int64_t offset, int whence) {
  Cursor& moved = *static_cast<Cursor*>(cursor);
  const auto size = static_cast<std::int64_t>(moved.output.file.size());
  if (whence == AVSEEK_SIZE) return size;
  const std::int64_t base = whence == SEEK_CUR ? moved.position : whence == SEEK_END ? size : 0;
  if (base + offset < 0) return AVERROR(EINVAL);
  return moved.position = base + offset;
}

AVIOContext* OpenCursor(Cursor& cursor, bool for_writing) {
  constexpr int kBufferBytes = 1 << 15;
  auto* const buffer = static_cast<unsigned char*>(av_malloc(kBufferBytes));
  AVIOContext* const io = avio_alloc_context(buffer, kBufferBytes, for_writing ? 1 : 0, &cursor,
                                             for_writing ? nullptr : &ReadSome,
                                             for_writing ? &WriteSome : nullptr, &Seek);
  if (io == nullptr) throw std::bad_alloc();
  return io;
}

bool EndsWith(const std::string& text, const std::string& ending) {
  return text.size() >= ending.size() &&
         std::equal(ending.rbegin(), ending.rend(), text.rbegin(), [](char wanted, char c) {
           return wanted == std::tolower(static_cast<unsigned char>(c));
         });
}

void CheckEnding(const std::string& path, const std::string& ending, const char* kind) {
  if (!EndsWith(path, ending)) {
    throw InputError(path, std::string(kind) + " needs a name that ends in " + ending);
  }
}

}  // namespace

struct VideoWriter::Encoder {
  Encoder(const std::string& file_path, int width, int height, int frames_per_second);

  // Rethrows what went wrong below libavformat, else says what it says.
  void Require(int code) {
    if (output.error) std::rethrow_exception(output.error);
    Check(code, path);
  }
  // Hands a frame to the encoder (null: no more) and writes what comes out of it.
  void Encode(const AVFrame* next);

  std::string path;
  Output output;
  Cursor writing{output}, reading{output};
  AvPtr<AVIOContext> io;
  AvPtr<AVFormatContext> format;
  AvPtr<AVCodecContext> codec;
  AVStream* stream = nullptr;  // owned by `format`
  AvPtr<SwsContext> scaler;
  AvPtr<AVFrame> frame;
  AvPtr<AVPacket> packet;
  int num_frames = 0;
};

VideoWriter::Encoder::Encoder(const std::string& file_path, int width, int height,
                              int frames_per_second)
    : path(file_path), output{AtomicFile(file_path), nullptr} {
  constexpr const char* kQuality = "20";
  const AVCodec* const x264 = avcodec_find_encoder_by_name("libx264");
  if (x264 == nullptr) {
    throw InputError(path, "cannot be encoded: this libavcodec has no libx264 encoder");
  }
  codec.reset(avcodec_alloc_context3(x264));
  codec->width = width;
  codec->height = height;
  codec->pix_fmt = AV_PIX_FMT_YUV420P;
  codec->time_base = {1, frames_per_second};
  codec->framerate = {frames_per_second, 1};
  codec->gop_size = 2 * frames_per_second;
  codec->thread_count = 1;  // more would make the bytes depend on the machine
  codec->color_range = AVCOL_RANGE_MPEG;
  codec->colorspace = AVCOL_SPC_BT709;
  codec->color_primaries = AVCOL_PRI_BT709;
  codec->color_trc = AVCOL_TRC_BT709;
  codec->flags |= AV_CODEC_FLAG_BITEXACT | AV_CODEC_FLAG_GLOBAL_HEADER;
  av_opt_set(codec->priv_data, "preset", "medium", 0);
  av_opt_set(codec->priv_data, "crf", kQuality, 0);
  Check(avcodec_open2(codec.get(), x264, nullptr), path);

  AVFormatContext* raw_format = nullptr;
  Check(avformat_alloc_output_context2(&raw_format, nullptr, "mp4", nullptr), path);
  format.reset(raw_format);
  format->flags |= AVFMT_FLAG_BITEXACT;
  stream = avformat_new_stream(format.get(), nullptr);
  if (stream == nullptr) throw std::bad_alloc();
  stream->time_base = codec->time_base;
  stream->avg_frame_rate = codec->framerate;
  Check(avcodec_parameters_from_context(stream->codecpar, codec.get()), path);
  io.reset(OpenCursor(writing, /*for_writing=*/true));
  format->pb = io.get();
  format->opaque = &reading;
  format->io_open = [](AVFormatContext* context, AVIOContext** opened, const char*, int flags,
                       AVDictionary**) {
    if ((flags & AVIO_FLAG_WRITE) != 0) return AVERROR(EINVAL);
    auto& cursor = *static_cast<Cursor*>(context->opaque);
    cursor.position = 0;
    *opened = OpenCursor(cursor, /*for_writing=*/false);
    return 0;
  };
  format->io_close2 = [](AVFormatContext*, AVIOContext* opened) {
    AvDeleter()(opened);
    return 0;
  };
  av_opt_set(format->priv_data, "movflags", "+faststart", 0);
  Require(avformat_write_header(format.get(), nullptr));

  scaler.reset(sws_getContext(width, height, AV_PIX_FMT_RGB24, width, height, AV_PIX_FMT_YUV420P,
                              SWS_BICUBIC | SWS_BITEXACT | SWS_ACCURATE_RND, nullptr, nullptr,
                              nullptr));
  if (!scaler) throw std::bad_alloc();
  constexpr int kFullRange = 1, kVideoRange = 0, kNoChange = 1 << 16;
  sws_setColorspaceDetails(scaler.get(), sws_getCoefficients(SWS_CS_ITU709), kFullRange,
                           sws_getCoefficients(SWS_CS_ITU709), kVideoRange, 0, kNoChange,
                           kNoChange);
  frame = MakeFrame(AV_PIX_FMT_YUV420P, width, height);
  packet.reset(av_packet_alloc());
  if (!packet) throw std::bad_alloc();
}

void VideoWriter::Encoder::Encode(const AVFrame* next) {
  Check(avcodec_send_frame(codec.get(), next), path);
  while (true) {
    const int code = avcodec_receive_packet(codec.get(), packet.get());
    if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return;
    Check(code, path);
    packet->duration = 1;
    packet->stream_index = stream->index;
    av_packet_rescale_ts(packet.get(), codec->time_base, stream->time_base);
    Require(av_interleaved_write_frame(format.get(), packet.get()));
  }
}

VideoWriter::VideoWriter(const std::string& path, int width, int height, int frames_per_second) {
  if (width < 2 || height < 2 || width % 2 != 0 || height % 2 != 0) {
    throw InputError("--size", std::to_string(width) + "x" + std::to_string(height) +
                                   ": width and height must be even and positive");
  }
  if (frames_per_second < 1 || frames_per_second > 240) {
    throw InputError("--fps", "must be 1 to 240, is " + std::to_string(frames_per_second));
  }
  av_log_set_level(AV_LOG_QUIET);
  CheckVideoName(path);
  encoder_ = std::make_unique<Encoder>(path, width, height, frames_per_second);
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::Add(const Image& image) {
  Encoder& encoder = *encoder_;
  if (image.width() != encoder.codec->width || image.height() != encoder.codec->height) {
    throw std::invalid_argument("VideoWriter: every frame must have the video's size");
  }
  if (av_frame_make_writable(encoder.frame.get()) < 0) throw std::bad_alloc();
  const std::uint8_t* const rows[] = {image.row(0)};
  const int strides[] = {3 * image.width()};
  sws_scale(encoder.scaler.get(), rows, strides, 0, image.height(), encoder.frame->data,
            encoder.frame->linesize);
  encoder.frame->pts = encoder.num_frames++;
  encoder.Encode(encoder.frame.get());
}

void VideoWriter::Finish() {
  Encoder& encoder = *encoder_;
  encoder.Encode(nullptr);
  encoder.Require(av_write_trailer(encoder.format.get()));
  avio_flush(encoder.io.get());
  encoder.Require(encoder.io->error);
  encoder.output.file.Commit();
}

std::string VideoEncoder() {
  const AVCodec* const x264 = avcodec_find_encoder_by_name("libx264");
  if (x264 == nullptr) return "";
  const unsigned version = avcodec_version();
  return std::string(x264->name) + ", libavcodec " + std::to_string(AV_VERSION_MAJOR(version)) +
         "." + std::to_string(AV_VERSION_MINOR(version)) + "." +
         std::to_string(AV_VERSION_MICRO(version));
}

void CheckVideoName(const std::string& path) { CheckEnding(path, ".mp4", "a video"); }
void CheckPngName(const std::string& path) { CheckEnding(path, ".png", "a picture"); }

void WritePng(const Image& image, const std::string& path) {
  CheckPngName(path);
  const AVCodec* const png = avcodec_find_encoder(AV_CODEC_ID_PNG);
  if (png == nullptr) throw InputError(path, "cannot be encoded: this libavcodec has no PNG");
  const AvPtr<AVCodecContext> codec(avcodec_alloc_context3(png));
  codec->width = image.width();
  codec->height = image.height();
  codec->pix_fmt = AV_PIX_FMT_RGB24;
  codec->time_base = {1, 1};
  codec->thread_count = 1;
  codec->flags |= AV_CODEC_FLAG_BITEXACT;
  Check(avcodec_open2(codec.get(), png, nullptr), path);
  const AvPtr<AVFrame> frame = MakeFrame(AV_PIX_FMT_RGB24, image.width(), image.height());
  for (int y = 0; y < image.height(); ++y) {
    std::memcpy(frame->data[0] + y * frame->linesize[0], image.row(y),
                3 * static_cast<std::size_t>(image.width()));
  }
  const AvPtr<AVPacket> packet(av_packet_alloc());
  if (!packet) throw std::bad_alloc();
  Check(avcodec_send_frame(codec.get(), frame.get()), path);
  Check(avcodec_receive_packet(codec.get(), packet.get()), path);

  WriteFile(path,
            {reinterpret_cast<const char*>(packet->data), static_cast<std::size_t>(packet->size)});
}

}  // namespace sidestep::render
