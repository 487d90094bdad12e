// FastDistanceTransform, full or bounded to 10 cells ("full", "bounded10"), on one thread.

#include <algorithm>
#include <limits>

#include "sidestep/bench/peers/worker.h"
#include "sidestep/core/cpu_time.h"
#include "sidestep/sdf/map/fast_distance_transform.h"

int main() {
  using namespace sidestep;
  sdf::FastDistanceTransform transform;
  sdf::AlignedVector<float> aligned;
  return ServeTransform(
      [&](const OccupancyGrid& grid, const std::string& variant, std::vector<float>& distance) {
        sdf::DistanceTransformOptions options{.convention = sdf::DistanceConvention::kBwdist};
        if (variant == "bounded10") options.max_distance_m = 10;
        aligned.resize(grid.cells.size());
        const double begin_s = ThreadCpuSeconds();
        transform.Compute(grid, options, aligned);
        const double elapsed_s = ThreadCpuSeconds() - begin_s;
        std::copy(aligned.begin(), aligned.end(), distance.begin());
        return elapsed_s;
      });
}
