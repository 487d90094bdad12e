#include "sidestep/render/comparison.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sidestep/core/input_error.h"
#include "sidestep/core/number_text.h"
#include "sidestep/record/questions.h"
#include "sidestep/render/timeline.h"
#include "sidestep/render/view_choice.h"

namespace sidestep::render {
namespace {

constexpr Color kWhite = {255, 255, 255};
constexpr Color kPale = {184, 194, 208};
constexpr Color kBackground = {22, 26, 33};
constexpr Color kTitleBar = {36, 42, 52};
constexpr Color kHardware = {112, 58, 140};

// Of a picture 720 lines high; others scale.
constexpr double kHeaderHeight = 40, kLegendHeight = 34, kBarHeight = 30, kGap = 4;
constexpr double kLargeText = 26, kText = 23, kSmallText = 21;
constexpr double kTextInset = 10;
constexpr int kContactFrame = 5;
constexpr const char* kUnknownSpeed = "obstacle's speed not known";
// Kept free around what is to be seen, as a share of the scene.
constexpr double kSceneMargin = 0.03;
constexpr int kLeastScenePixels = 32;

int ToPixels(double length) { return static_cast<int>(std::lround(length)); }

// Columns of the grid: as square as can be, two traces side by side.
int NumColumns(std::size_t num_traces) {
  return static_cast<int>(std::ceil(std::sqrt(static_cast<double>(num_traces))));
}

}  // namespace

Comparison::Panel::Panel(const GlContext& gl, const NamedRecording& trace,
                         const PixelRect& place_of_panel, const PixelRect& place_of_scene)
    : model(trace.recording, trace.name),
      painter(gl, model, place_of_scene.width, place_of_scene.height),
      title(TitleOf(trace.recording, trace.name)),
      place(place_of_panel),
      scene(place_of_scene) {}

Comparison::Comparison(const GlContext& gl, const std::vector<NamedRecording>& traces,
                       const PictureOptions& options)
    : width_(options.width),
      height_(options.height),
      scale_(std::min(options.width / 1280.0, options.height / 720.0)),
      playback_speed_(options.playback_speed),
      font_(gl) {
  if (traces.empty()) throw InputError("TRACE", "give at least one");
  if (traces.size() > kMaxTraces) {
    throw InputError("TRACE", "at most " + std::to_string(kMaxTraces) + " fit side by side");
  }
  if (!options.titles.empty() && options.titles.size() != traces.size()) {
    throw InputError("--title", "give one for each of the " + std::to_string(traces.size()) +
                                    " traces, not " + std::to_string(options.titles.size()));
  }
  const int columns = NumColumns(traces.size());
  const int rows = (static_cast<int>(traces.size()) + columns - 1) / columns;
  const int gap = std::max(1, ToPixels(kGap * scale_));
  const int bar = ToPixels(kBarHeight * scale_);
  const int top = ToPixels(kHeaderHeight * scale_);
  const int space_x = options.width - gap * (columns - 1);
  const int space_y = options.height - top - ToPixels(kLegendHeight * scale_) - gap * (rows - 1);
  if (space_x / columns < kLeastScenePixels || space_y / rows - 2 * bar < kLeastScenePixels) {
    throw InputError("--size", std::to_string(options.width) + "x" +
                                   std::to_string(options.height) + " is too small for " +
                                   std::to_string(traces.size()) + " traces");
  }
  for (int i = 0; i < rows * columns; ++i) {
    const int column = i % columns, row = i / columns;
    const int left = column * (space_x + gap * columns) / columns;
    const int upper = top + row * (space_y + gap * rows) / rows;
    const PixelRect place = {left, upper, space_x / columns, space_y / rows};
    const PixelRect scene = {left, upper + bar, place.width, place.height - 2 * bar};
    if (static_cast<std::size_t>(i) < traces.size()) {
      panels_.emplace_back(gl, traces[static_cast<std::size_t>(i)], place, scene);
    } else {
      empty_places_.push_back(place);
    }
  }
  for (std::size_t i = 0; i < options.titles.size(); ++i) {
    std::next(panels_.begin(), static_cast<std::ptrdiff_t>(i))->title = {options.titles[i], ""};
  }
  const std::map<std::string, std::string>& header = traces.front().recording.header;
  const auto scenario = header.find("scenario");
  heading_ = scenario == header.end() ? traces.front().name : scenario->second;
  ChooseViews(options);
}

void Comparison::ChooseViews(const PictureOptions& options) {
  if (!options.camera.empty()) {
    for (Panel& panel : panels_) panel.painter.LookThrough(options.camera);
    return;
  }
  std::vector<TraceModel*> models;
  for (Panel& panel : panels_) models.push_back(&panel.model);
  const PixelRect& scene = panels_.front().scene;
  Frustum frustum = ScenePainter::FullFrustum(scene.width, scene.height);
  for (double* const side : {&frustum.left, &frustum.right, &frustum.bottom, &frustum.top}) {
    *side *= 1 - 2 * kSceneMargin;
  }
  const CameraView view = ChooseView(models, frustum);
  for (Panel& panel : panels_) panel.painter.LookFrom(view);
}

EpisodeTime Comparison::end() const {
  EpisodeTime end;
  for (const Panel& panel : panels_) end = std::max(end, record::EndOf(panel.model.recording()));
  return end;
}

EpisodeTime Comparison::telling_moment() const {
  std::optional<EpisodeTime> first_touch;
  std::optional<record::Clearance> least;
  for (const Panel& panel : panels_) {
    const record::Recording& recording = panel.model.recording();
    const std::optional<record::Touch> touch = record::FirstTouch(recording);
    if (touch && (!first_touch || touch->t < *first_touch)) first_touch = touch->t;
    const std::optional<record::Clearance> clearance = record::LeastClearance(recording, end());
    if (clearance && (!least || clearance->clearance_m < least->clearance_m)) least = clearance;
  }
  if (first_touch) return *first_touch;
  if (least) return least->t;
  for (const Panel& panel : panels_) {
    if (const auto stop = record::FirstStop(panel.model.recording())) return *stop;
  }
  return EpisodeTime(0);
}

std::vector<std::string> Comparison::names_not_shown() const {
  std::vector<std::string> names = {heading_};
  for (const Panel& panel : panels_) {
    names.push_back(panel.title.name);
    const std::vector<std::string>& obstacles = panel.model.recording().obstacles;
    names.insert(names.end(), obstacles.begin(), obstacles.end());
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  std::erase_if(names, Font::HasAll);
  return names;
}

void Comparison::DrawHeader(Image& image, EpisodeTime t) const {
  const double line = kLargeText * scale_;
  const double y = (kHeaderHeight - kLargeText) / 2 * scale_;
  font_.Draw(image, kTextInset * scale_, y, line, kWhite, heading_);
  std::string clock = "t = " + FiniteText("{:.2f} s", t.seconds());
  if (playback_speed_ != 1) clock += FiniteText("  (played at {:g} x)", playback_speed_);
  font_.Draw(image, width_ - font_.Width(clock, line) - kTextInset * scale_, y, line, kWhite,
             clock);
}

void Comparison::DrawLegend(Image& image) const {
  struct Item {
    Color color;
    const char* text;
  };
  constexpr Item kItems[] = {{kTrailColor, "path so far"},
                             {kPlanColor, "planned path"},
                             {kPredictionColor, "where the planner expects the obstacle"},
                             {kContactColor, "contact"}};
  const double line = kSmallText * scale_, swatch = 14 * scale_, space = 8 * scale_;
  const double top = height_ - kLegendHeight * scale_;
  double x = kTextInset * scale_;
  for (const Item& item : kItems) {
    image.Fill({ToPixels(x), ToPixels(top + (kLegendHeight * scale_ - swatch) / 2),
                ToPixels(swatch), ToPixels(swatch)},
               item.color);
    x = font_.Draw(image, x + swatch + space, top + (kLegendHeight - kSmallText) / 2 * scale_, line,
                   kPale, item.text) +
        3 * space;
  }
}

void Comparison::DrawPanel(Image& image, Panel& panel, EpisodeTime t) const {
  const record::Recording& recording = panel.model.recording();
  const EpisodeTime own_end = record::EndOf(recording);
  const bool finished = t > own_end;
  const EpisodeTime own_t = std::min(t, own_end);
  if (finished && !panel.last_picture) panel.last_picture = panel.painter.Draw(own_t);
  image.Paste(finished ? *panel.last_picture : panel.painter.Draw(own_t), panel.scene.x,
              panel.scene.y);

  const PixelRect& place = panel.place;
  const double inset = kTextInset * scale_;
  const double text = kText * scale_, small = kSmallText * scale_;
  const int bar = panel.scene.y - place.y;
  const double space = place.width - 2 * inset;

  image.Fill({place.x, place.y, place.width, bar}, kTitleBar);
  const double title_shrink = std::min(1.0, space / font_.Width(panel.title.name, text));
  double x = font_.Draw(image, place.x + inset, place.y + (bar - text * title_shrink) / 2,
                        text * title_shrink, kWhite, panel.title.name);
  x += inset;
  if (x + font_.Width(panel.title.explanation, small) < place.x + place.width - inset) {
    font_.Draw(image, x, place.y + (bar - small) / 2, small, kPale, panel.title.explanation);
  }

  const std::string where = PlaceOf(recording);
  if (!where.empty()) {
    const double pad = inset / 2;
    const double shrink = std::min(1.0, space / font_.Width(where, small));
    image.Fill(
        {panel.scene.x, panel.scene.y, ToPixels(font_.Width(where, small * shrink) + 2 * pad),
         ToPixels(small * shrink + 2 * pad)},
        kHardware);
    font_.Draw(image, panel.scene.x + pad, panel.scene.y + pad, small * shrink, kWhite, where);
  }

  const Status status = StatusAt(recording, own_t);
  const int bar_y = panel.scene.y + panel.scene.height;
  image.Fill({place.x, bar_y, place.width, place.y + place.height - bar_y}, ColorOf(status.mood));
  const double status_shrink = std::min(1.0, space / std::max(1.0, font_.Width(status.text, text)));
  x = font_.Draw(image, place.x + inset, bar_y + (bar - text * status_shrink) / 2,
                 text * status_shrink, kWhite, status.text);
  const std::string note =
      finished ? "finished"
               : FiniteText("obstacle {:.2f} m/s", ObstacleSpeedAt(recording, t), kUnknownSpeed);
  const double note_x = place.x + place.width - inset - font_.Width(note, small);
  if (note_x > x + inset && (finished || !recording.obstacles.empty())) {
    font_.Draw(image, note_x, bar_y + (bar - small) / 2, small, kWhite, note);
  }
  if (status.mood == Mood::kBad) {
    image.Outline(place, ColorOf(Mood::kBad), std::max(2, ToPixels(kContactFrame * scale_)));
  }
}

void Comparison::DrawSummary(Image& image, const PixelRect& place, EpisodeTime t) const {
  const double inset = 2 * kTextInset * scale_;
  const double space = place.width - 2 * inset;
  double y = place.y + inset;
  for (const Panel& panel : panels_) {
    const Status status = StatusAt(panel.model.recording(), t);
    const double line = kText * scale_;
    const double shrink = std::min(1.0, space / std::max({1.0, font_.Width(panel.title.name, line),
                                                          font_.Width(status.text, line)}));
    font_.Draw(image, place.x + inset, y, line * shrink, kWhite, panel.title.name);
    font_.Draw(image, place.x + inset, y + 1.1 * line, line * shrink,
               status.mood == Mood::kBad ? kContactColor : kPale, status.text);
    y += 3 * line;
  }
}

Image Comparison::Draw(EpisodeTime t) {
  Image image(width_, height_);
  image.Fill({0, 0, width_, height_}, kBackground);
  DrawHeader(image, std::min(t, end()));
  DrawLegend(image);
  for (Panel& panel : panels_) DrawPanel(image, panel, t);
  if (!empty_places_.empty()) DrawSummary(image, empty_places_.front(), t);
  return image;
}

}  // namespace sidestep::render
