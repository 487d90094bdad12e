// ITK's SignedMaurerDistanceMapImageFilter, on one thread. Inside, it measures to the filled cells
// at the border, not to the free ones beyond.

#include <itkImage.h>
#include <itkImportImageFilter.h>
#include <itkMultiThreaderBase.h>
#include <itkSignedMaurerDistanceMapImageFilter.h>

#include <algorithm>
#include <ctime>

#include "sidestep/bench/peers/worker.h"

namespace {

// ITK works on threads of its own, even if it is told to use one.
double ProcessCpuSeconds() {
  std::timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

int main() {
  using namespace sidestep;
  using Cells = itk::Image<unsigned char, 3>;
  using Distances = itk::Image<float, 3>;
  itk::MultiThreaderBase::SetGlobalMaximumNumberOfThreads(1);
  return ServeTransform(
      [](const OccupancyGrid& grid, const std::string&, std::vector<float>& distance) {
        const auto import = itk::ImportImageFilter<unsigned char, 3>::New();
        itk::ImageRegion<3> region;
        for (unsigned a = 0; a < 3; ++a) {
          region.SetSize(a, static_cast<itk::SizeValueType>(grid.spec.size[a]));
        }
        import->SetRegion(region);
        import->SetImportPointer(const_cast<unsigned char*>(grid.cells.data()), grid.cells.size(),
                                 /*LetImageContainerManageMemory=*/false);
        import->Update();
        const auto maurer = itk::SignedMaurerDistanceMapImageFilter<Cells, Distances>::New();
        maurer->SetInput(import->GetOutput());
        maurer->SetSquaredDistance(false);
        maurer->SetUseImageSpacing(true);
        maurer->SetInsideIsPositive(false);
        const double begin_s = ProcessCpuSeconds();
        maurer->Update();
        const double elapsed_s = ProcessCpuSeconds() - begin_s;
        std::copy_n(maurer->GetOutput()->GetBufferPointer(), distance.size(), distance.begin());
        return elapsed_s;
      });
}
