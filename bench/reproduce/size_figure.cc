#include "sidestep/bench/reproduce/size_figure.h"

#include <utility>

namespace sidestep::bench {

Figure MakeSizeFigure(const std::string& title, const std::string& y_label,
                      const std::vector<SizeCurve>& curves) {
  Panel panel;
  panel.x_label = "voxels per side";
  panel.y_label = y_label;
  panel.log_y = true;
  std::vector<Series> rings;
  int color = 0;
  for (const SizeCurve& curve : curves) {
    panel.series.push_back(
        {curve.words, Series::Style::kLine, color, curve.voxels, curve.y, curve.low, curve.high});
    if (!curve.published_voxels.empty()) {
      rings.push_back({"",
                       Series::Style::kOpenPoints,
                       color,
                       curve.published_voxels,
                       curve.published_y,
                       {},
                       {}});
    }
    ++color;
  }
  panel.title = title + (rings.empty() ? "" : " (rings: published)");
  panel.series.insert(panel.series.end(), rings.begin(), rings.end());
  Figure figure;
  figure.panels = {std::move(panel)};
  figure.panel_width_px = 720;
  figure.panel_height_px = 520;
  return figure;
}

}  // namespace sidestep::bench
