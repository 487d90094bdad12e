#include "sidestep/render/video_writer.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/imgutils.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "sidestep/core/input_error.h"

namespace sidestep::render {
namespace {

struct AvDeleter {
  void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
  void operator()(AVFormatContext* format) const {
    if (format->pb != nullptr) avio_closep(&format->pb);
    avformat_free_context(format);
  }
};
template <typename T>
using AvPtr = std::unique_ptr<T, AvDeleter>;

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

// A temporary name beside `path`, so that nobody ever sees half a file.
std::string TemporaryName(const std::string& path) {
  return path + "." + std::to_string(getpid()) + ".part";
}

void Rename(const std::string& from, const std::string& to) {
  if (std::rename(from.c_str(), to.c_str()) == 0) return;
  const std::string why = std::strerror(errno);
  std::remove(from.c_str());
  throw InputError(to, "cannot be written: " + why);
}

}  // namespace

struct VideoWriter::Encoder {
  std::string path;
  std::string temporary;
  AvPtr<AVFormatContext> format;
  AvPtr<AVCodecContext> codec;
  AVStream* stream = nullptr;  // owned by `format`
  AvPtr<SwsContext> scaler;
  AvPtr<AVFrame> frame;
  AvPtr<AVPacket> packet;
  int num_frames = 0;
  bool finished = false;

  ~Encoder() {
    if (finished) return;
    format.reset();
    std::remove(temporary.c_str());
  }

  void Open(int width, int height, int frames_per_second);
  // Hands a frame to the encoder (null: no more) and writes what comes out of it.
  void Encode(const AVFrame* next);
};

void VideoWriter::Encoder::Open(int width, int height, int frames_per_second) {
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
  Check(avformat_alloc_output_context2(&raw_format, nullptr, "mp4", temporary.c_str()), path);
  format.reset(raw_format);
  format->flags |= AVFMT_FLAG_BITEXACT;
  stream = avformat_new_stream(format.get(), nullptr);
  if (stream == nullptr) throw std::bad_alloc();
  stream->time_base = codec->time_base;
  stream->avg_frame_rate = codec->framerate;
  Check(avcodec_parameters_from_context(stream->codecpar, codec.get()), path);
  Check(avio_open(&format->pb, temporary.c_str(), AVIO_FLAG_WRITE), path);
  av_opt_set(format->priv_data, "movflags", "+faststart", 0);
  Check(avformat_write_header(format.get(), nullptr), path);

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
    Check(av_interleaved_write_frame(format.get(), packet.get()), path);
  }
}

VideoWriter::VideoWriter(const std::string& path, int width, int height, int frames_per_second)
    : encoder_(std::make_unique<Encoder>()) {
  if (width < 2 || height < 2 || width % 2 != 0 || height % 2 != 0) {
    throw InputError("--size", std::to_string(width) + "x" + std::to_string(height) +
                                   ": width and height must be even and positive");
  }
  if (frames_per_second < 1 || frames_per_second > 240) {
    throw InputError("--fps", "must be 1 to 240, is " + std::to_string(frames_per_second));
  }
  av_log_set_level(AV_LOG_QUIET);
  encoder_->path = path;
  encoder_->temporary = TemporaryName(path);
  encoder_->Open(width, height, frames_per_second);
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
  Check(av_write_trailer(encoder.format.get()), encoder.path);
  Check(avio_closep(&encoder.format->pb), encoder.path);
  Rename(encoder.temporary, encoder.path);
  encoder.finished = true;
}

std::string VideoEncoder() {
  const AVCodec* const x264 = avcodec_find_encoder_by_name("libx264");
  if (x264 == nullptr) return "";
  const unsigned version = avcodec_version();
  return std::string(x264->name) + ", libavcodec " + std::to_string(AV_VERSION_MAJOR(version)) +
         "." + std::to_string(AV_VERSION_MINOR(version)) + "." +
         std::to_string(AV_VERSION_MICRO(version));
}

void WritePng(const Image& image, const std::string& path) {
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
                static_cast<std::size_t>(3 * image.width()));
  }
  const AvPtr<AVPacket> packet(av_packet_alloc());
  if (!packet) throw std::bad_alloc();
  Check(avcodec_send_frame(codec.get(), frame.get()), path);
  Check(avcodec_receive_packet(codec.get(), packet.get()), path);

  const std::string temporary = TemporaryName(path);
  std::ofstream stream(temporary, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(packet->data), packet->size);
  stream.close();
  if (!stream) {
    const std::string why = std::strerror(errno);
    std::remove(temporary.c_str());
    throw InputError(path, "cannot be written: " + why);
  }
  Rename(temporary, path);
}

}  // namespace sidestep::render
