// FastDistanceTransform, full or bounded to 10 cells ("full", "bounded10"), on one thread.

#include <algorithm>
#include <limits>

#include "bench/peers/worker.h"
#include "core/cpu_time.h"
#include "sdf/map/fast_distance_transform.h"

int main() {
  using namespace sidestep;
  FastDistanceTransform transform;
  AlignedVector<float> aligned;
  return ServeTransform(
      [&](const OccupancyGrid& grid, const std::string& variant, std::vector<float>& distance) {
        DistanceTransformOptions options{.convention = DistanceConvention::kBwdist};
        if (variant == "bounded10") options.max_distance_m = 10;
        aligned.resize(grid.cells.size());
        const double begin_s = ThreadCpuSeconds();
        transform.Compute(grid, options, aligned);
        const double elapsed_s = ThreadCpuSeconds() - begin_s;
        std::copy(aligned.begin(), aligned.end(), distance.begin());
        return elapsed_s;
      });
}
