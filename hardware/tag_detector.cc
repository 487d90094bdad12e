#include "sidestep/hardware/tag_detector.h"

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include <algorithm>
#include <map>

namespace sidestep::hardware {
namespace {

// The library wants room around a pixel; nothing smaller holds a tag that could be read.
constexpr int kLeastImage_px = 32;

double FromRim(const TagDetection& tag, const robot::GreyImage& image) {
  const Eigen::Array2d last(image.width - 1, image.height - 1);
  const Eigen::Array2d least = tag.corners_px.rowwise().minCoeff();
  const Eigen::Array2d most = tag.corners_px.rowwise().maxCoeff();
  return least.min(last - most).minCoeff();
}

struct DestroyDetections {
  void operator()(zarray_t* list) const { apriltag_detections_destroy(list); }
};

}  // namespace

struct TagDetector::Library {
  apriltag_family_t* family = tag36h11_create();
  apriltag_detector_t* detector = apriltag_detector_create();

  Library() = default;
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
  ~Library() {
    apriltag_detector_destroy(detector);
    tag36h11_destroy(family);
  }
};

TagDetector::TagDetector(const TagDetectorOptions& options)
    : options_(options), library_(new Library) {
  apriltag_detector_add_family_bits(library_->detector, library_->family, options.most_hamming);
  library_->detector->nthreads = 1;
  library_->detector->quad_decimate = static_cast<float>(options.decimate);
  library_->detector->refine_edges = true;
}

TagDetector::~TagDetector() = default;

void TagDetector::DeleteLibrary::operator()(Library* library) const { delete library; }

std::vector<TagDetection> TagDetector::Detect(const robot::GreyImage& image) {
  if (image.width < kLeastImage_px || image.height < kLeastImage_px) return {};
  image_u8_t view = {image.width, image.height, image.width,
                     const_cast<std::uint8_t*>(image.pixels.data())};  // it is only read
  const std::unique_ptr<zarray_t, DestroyDetections> found(
      apriltag_detector_detect(library_->detector, &view));
  std::map<int, std::vector<TagDetection>> by_id;
  for (int i = 0; i < zarray_size(found.get()); ++i) {
    const apriltag_detection_t* seen = nullptr;
    zarray_get(found.get(), i, &seen);
    TagDetection tag;
    tag.id = seen->id;
    tag.hamming = seen->hamming;
    tag.margin = seen->decision_margin;
    // Its (0, 0) is the corner of the first pixel, not its centre.
    for (int k = 0; k < 4; ++k) {
      tag.corners_px.col(k) = Eigen::Vector2d(seen->p[k][0] - 0.5, seen->p[k][1] - 0.5);
    }
    if (tag.margin < options_.least_margin || !tag.corners_px.allFinite() ||
        tag.shortest_edge_px() < options_.least_edge_px ||
        FromRim(tag, image) < options_.least_from_rim_px) {
      continue;
    }
    by_id[tag.id].push_back(tag);
  }
  std::vector<TagDetection> tags;
  for (const auto& [id, same] : by_id) {
    if (same.size() == 1) tags.push_back(same.front());
  }
  return tags;
}

bool CanFindTags() { return true; }

}  // namespace sidestep::hardware
