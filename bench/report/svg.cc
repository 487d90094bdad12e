#include "sidestep/bench/report/svg.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "sidestep/bench/report/html_page.h"
#include "sidestep/core/utf8.h"

namespace sidestep::bench {
namespace {

constexpr double kLeft = 62, kRight = 16, kBottom = 54, kKeyLine = 20, kTitle = 22;
constexpr double kLetter = 7.1;  // about as wide as one of 13 px
constexpr std::size_t kLongestName = 28;

std::string Shortened(const std::string& text) {
  if (text.size() <= kLongestName) return text;
  return std::string(Utf8Prefix(text, kLongestName - 3)) + "...";
}

double Width(const std::string& text) { return kLetter * static_cast<double>(text.size()); }

// One axis: from values to pixels, and where its ticks are.
class Axis {
 public:
  Axis(double low, double high, bool is_log, double begin_px, double end_px)
      : low_(is_log ? std::log10(low) : low),
        high_(is_log ? std::log10(high) : high),
        is_log_(is_log),
        begin_px_(begin_px),
        end_px_(end_px) {}

  double At(double value) const {
    const double place = is_log_ ? std::log10(std::max(value, 1e-300)) : value;
    return begin_px_ + (end_px_ - begin_px_) * (place - low_) / (high_ - low_);
  }

  std::vector<double> Ticks(int about) const {
    std::vector<double> ticks;
    if (is_log_) {
      const int first = static_cast<int>(std::floor(low_)),
                last = static_cast<int>(std::floor(high_));
      for (int power = first; power <= last; ++power) {
        for (const double factor : {1.0, 2.0, 5.0}) {
          const double place = power + std::log10(factor);
          if (place < low_ - 1e-9 || place > high_ + 1e-9) continue;
          if (high_ - low_ > 2 && factor > 1) continue;
          ticks.push_back(factor * std::pow(10, power));
        }
      }
      return ticks;
    }
    const double rough = (high_ - low_) / about;
    const double power = std::pow(10, std::floor(std::log10(rough)));
    double step = 10 * power;
    for (const double factor : {5.0, 2.0, 1.0}) {
      if (factor * power >= 0.999 * rough) step = factor * power;
    }
    const auto first = std::ceil(low_ / step - 1e-9);
    const int count = static_cast<int>(std::floor(high_ / step + 1e-9) - first) + 1;
    for (int n = 0; n < count; ++n) ticks.push_back((first + n) * step + 0.0);
    return ticks;
  }

 private:
  double low_, high_;
  bool is_log_;
  double begin_px_, end_px_;
};

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void Include(double value, bool is_log) {
    if (!std::isfinite(value) || (is_log && value <= 0)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  // With some air around it.
  void Widen(bool is_log) {
    if (!(low <= high)) {
      low = is_log ? 1 : 0;
      high = is_log ? 10 : 1;
    }
    if (is_log) {
      const double share = low == high ? 1.5 : 1.05;
      low /= share;
      high *= share;
    } else {
      const double air = low == high ? std::max(0.5, 0.1 * std::abs(low)) : 0.04 * (high - low);
      low -= air;
      high += air;
    }
  }
};

class SvgPanel {
 public:
  SvgPanel(const Panel& panel, SvgPlace place, int width, int height)
      : panel_(panel),
        place_(place),
        width_(width),
        height_(height),
        top_((panel.title.empty() ? 6 : kTitle) + KeyHeight()),
        x_(XAxis()),
        y_(YAxis()) {}

  std::string Draw() {
    Begin();
    DrawGrid();
    DrawKey();
    for (const Series& series : panel_.series) DrawSeries(series);
    return text_ + "</svg>\n";
  }

 private:
  // The titles of series stand above, in as many lines as they need.
  std::vector<std::pair<double, double>> KeyPlaces() const {
    std::vector<std::pair<double, double>> places;
    double x = kLeft, y = 0;
    for (const Series& series : panel_.series) {
      const double width = series.title.empty() ? 0 : Width(Shortened(series.title)) + 34;
      if (x > kLeft && x + width > width_ - kRight) {
        x = kLeft;
        y += kKeyLine;
      }
      places.emplace_back(x, y);
      x += width;
    }
    return places;
  }
  double KeyHeight() const {
    const bool has_key = std::any_of(panel_.series.begin(), panel_.series.end(),
                                     [](const Series& series) { return !series.title.empty(); });
    return has_key ? KeyPlaces().back().second + kKeyLine + 4 : 6;
  }

  Axis XAxis() const {
    const double end = width_ - kRight;
    if (!panel_.x_names.empty()) {
      return {-0.5, static_cast<double>(panel_.x_names.size()) - 0.5, false, kLeft, end};
    }
    Range range;
    for (const Series& series : panel_.series) {
      for (const double x : series.x) range.Include(x, panel_.log_x);
    }
    range.Widen(panel_.log_x);
    return {range.low, range.high, panel_.log_x, kLeft, end};
  }

  Axis YAxis() const {
    const double begin = height_ - kBottom;
    if (panel_.y_range.size() == 2) {
      return {panel_.y_range[0], panel_.y_range[1], panel_.log_y, begin, top_};
    }
    Range range;
    for (const Series& series : panel_.series) {
      for (const std::vector<double>* const values : {&series.y, &series.low, &series.high}) {
        for (const double y : *values) range.Include(y, panel_.log_y);
      }
    }
    range.Widen(panel_.log_y);
    return {range.low, range.high, panel_.log_y, begin, top_};
  }

  void Begin() {
    text_ = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" {}role=\"img\" "
        "class=\"figure\" font-family=\"system-ui, sans-serif\" font-size=\"13\">\n",
        width_, height_,
        place_ == SvgPlace::kFile ? fmt::format("width=\"{}\" height=\"{}\" ", width_, height_)
                                  : "");
    text_ +=
        "<title>" + Escaped(panel_.title.empty() ? panel_.y_label : panel_.title) + "</title>\n";
    if (place_ == SvgPlace::kFile) {
      text_ +=
          "<style>.figure { --ink: #1d232b; --quiet: #5a6573; --line: #dde2e8; --card: #fff; }"
          "</style>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
    }
    if (!panel_.title.empty()) {
      Text(kLeft, 15, "start", "--ink", panel_.title, " font-weight=\"600\"");
    }
  }

  void Text(double x, double y, const char* anchor, const char* color, const std::string& words,
            const std::string& more = "") {
    text_ += fmt::format(
        "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" fill=\"var({})\"{}>{}</text>\n", x, y,
        anchor, color, more, Escaped(words));
  }

  void Line(double x1, double y1, double x2, double y2, const char* color) {
    text_ += fmt::format(
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"var({})\"/>\n", x1,
        y1, x2, y2, color);
  }

  void DrawGrid() {
    const double bottom = height_ - kBottom, right = width_ - kRight;
    for (const double tick : y_.Ticks(5)) {
      Line(kLeft, y_.At(tick), right, y_.At(tick), "--line");
      Text(kLeft - 7, y_.At(tick) + 4.5, "end", "--quiet", fmt::format("{:.6g}", tick));
    }
    if (panel_.x_names.empty()) {
      for (const double tick : x_.Ticks(7)) {
        Line(x_.At(tick), bottom, x_.At(tick), bottom + 5, "--quiet");
        Text(x_.At(tick), bottom + 19, "middle", "--quiet", fmt::format("{:.6g}", tick));
      }
    } else {
      DrawNames(bottom);
    }
    Line(kLeft, bottom, right, bottom, "--quiet");
    Text((kLeft + right) / 2, height_ - 6, "middle", "--ink", panel_.x_label);
    const double middle = (top_ + bottom) / 2;
    Text(14, middle, "middle", "--ink", panel_.y_label,
         fmt::format(" transform=\"rotate(-90 14 {:.1f})\"", middle));
  }

  // Of many or long names every second, third, ... so that none runs into the next.
  void DrawNames(double bottom) {
    double widest = 0;
    for (const std::string& name : panel_.x_names) {
      widest = std::max(widest, Width(Shortened(name)) + 8);
    }
    const double room = x_.At(1) - x_.At(0);
    const auto every = static_cast<std::size_t>(std::max(1.0, std::ceil(widest / (2 * room))));
    for (std::size_t i = 0; i < panel_.x_names.size(); i += every) {
      // In two rows, if one is too narrow.
      const bool is_lower = widest > room * static_cast<double>(every) && (i / every) % 2 == 1;
      Text(x_.At(static_cast<double>(i)), bottom + (is_lower ? 31 : 17), "middle", "--quiet",
           Shortened(panel_.x_names[i]));
    }
  }

  void DrawKey() {
    const auto places = KeyPlaces();
    const double first = panel_.title.empty() ? 14 : kTitle + 12;
    for (std::size_t i = 0; i < panel_.series.size(); ++i) {
      const Series& series = panel_.series[i];
      if (series.title.empty()) continue;
      const auto [x, y] = places[i];
      text_ += fmt::format(
          "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"14\" height=\"5\" rx=\"2\" fill=\"{}\"/>\n", x,
          first + y - 7, ColorOf(series));
      Text(x + 19, first + y, "start", "--ink", Shortened(series.title));
    }
  }

  // The last of the palette is black, which would not be seen on a dark page.
  std::string ColorOf(const Series& series) const {
    const std::string color = FigureColor(series.color);
    return color == "#000000" ? "var(--ink)" : color;
  }

  bool IsDrawable(const Series& series, std::size_t i) const {
    return std::isfinite(series.x[i]) && std::isfinite(series.y[i]) &&
           !(panel_.log_x && series.x[i] <= 0) && !(panel_.log_y && series.y[i] <= 0);
  }

  void DrawSeries(const Series& series) {
    const bool has_bounds = !series.low.empty();
    if (series.x.size() != series.y.size() || series.low.size() != series.high.size() ||
        (has_bounds && series.low.size() != series.x.size())) {
      throw std::invalid_argument("ToSvg: a series' columns differ in length");
    }
    const bool is_bars = series.style == Series::Style::kBars;
    if (has_bounds) is_bars ? DrawBars(series) : DrawBand(series);
    if (!is_bars && series.style != Series::Style::kOpenPoints) DrawLine(series);
    if (series.style != Series::Style::kPlainLine) DrawPoints(series);
  }

  void DrawBand(const Series& series) {
    std::string there, back;
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (!IsDrawable(series, i)) continue;
      if (!std::isfinite(series.low[i]) || !std::isfinite(series.high[i])) continue;
      there += fmt::format("{:.1f},{:.1f} ", x_.At(series.x[i]), y_.At(series.high[i]));
      back = fmt::format("{:.1f},{:.1f} ", x_.At(series.x[i]), y_.At(series.low[i])) + back;
    }
    text_ += fmt::format("<polygon points=\"{}{}\" fill=\"{}\" fill-opacity=\"0.16\"/>\n", there,
                         back, ColorOf(series));
  }

  void DrawBars(const Series& series) {
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (!IsDrawable(series, i)) continue;
      if (!std::isfinite(series.low[i]) || !std::isfinite(series.high[i])) continue;
      const double x = x_.At(series.x[i]), low = y_.At(series.low[i]), high = y_.At(series.high[i]);
      text_ += fmt::format(
          "<path d=\"M{0:.1f} {1:.1f}V{2:.1f}M{3:.1f} {1:.1f}h10M{3:.1f} {2:.1f}h10\" "
          "fill=\"none\" "
          "stroke=\"{4}\" stroke-width=\"2\"/>\n",
          x, low, high, x - 5, ColorOf(series));
    }
  }

  void DrawLine(const Series& series) {
    std::string points;
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (!IsDrawable(series, i)) continue;
      points += fmt::format("{:.1f},{:.1f} ", x_.At(series.x[i]), y_.At(series.y[i]));
    }
    text_ += fmt::format(
        "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\" "
        "stroke-linejoin=\"round\"/>\n",
        points, ColorOf(series));
  }

  void DrawPoints(const Series& series) {
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (!IsDrawable(series, i)) continue;
      const bool is_open = series.style == Series::Style::kOpenPoints;
      const std::string color = ColorOf(series);
      std::string what = series.title.empty() ? "" : series.title + ": ";
      const auto name = static_cast<std::size_t>(std::max(0.0, series.x[i]));
      what += name < panel_.x_names.size() ? panel_.x_names[name] + ", "
                                           : fmt::format("{:.6g}, ", series.x[i]);
      what += fmt::format("{:.4g}", series.y[i]);
      if (!series.low.empty() && std::isfinite(series.low[i])) {
        what += fmt::format(" ({:.4g} to {:.4g})", series.low[i], series.high[i]);
      }
      text_ += fmt::format(
          "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\" stroke=\"{}\" "
          "stroke-width=\"1.5\"><title>{}</title></circle>\n",
          x_.At(series.x[i]), y_.At(series.y[i]), is_open ? "none" : color,
          is_open ? color : "var(--card)", Escaped(what));
    }
  }

  const Panel& panel_;
  SvgPlace place_;
  double width_, height_, top_;
  Axis x_, y_;
  std::string text_;
};

}  // namespace

std::string ToSvg(const Panel& panel, SvgPlace place, int width_px, int height_px) {
  return SvgPanel(panel, place, width_px, height_px).Draw();
}

}  // namespace sidestep::bench
