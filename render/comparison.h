#pragma once

#include <list>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/core/time.h"
#include "sidestep/record/recording.h"
#include "sidestep/render/captions.h"
#include "sidestep/render/font.h"
#include "sidestep/render/gl_context.h"
#include "sidestep/render/image.h"
#include "sidestep/render/scene_painter.h"
#include "sidestep/render/trace_model.h"

namespace sidestep::render {

struct NamedRecording {
  std::string name;  ///< for messages, and as the title of last resort
  record::Recording recording;
};

struct PictureOptions {
  int width = 1280, height = 720;   ///< [pixels] of the whole picture
  std::string camera;               ///< of the model; empty: chosen from what there is to see
  std::vector<std::string> titles;  ///< one a trace; empty: what each planner was told
  double playback_speed = 1;        ///< only to be written on the picture
};

/// Pictures of several episodes side by side at the same moment: a panel each, with title, scene
/// and status, under one clock and over one legend. An episode that is over stands still.
class Comparison {
 public:
  static constexpr std::size_t kMaxTraces = 16;

  /// `traces` must outlive it.
  /// @throws InputError for no traces or too many, a picture too small to hold them, another number
  ///   of titles than traces, a camera that a model has not, a trace with nothing to draw.
  Comparison(const GlContext& gl, const std::vector<NamedRecording>& traces,
             const PictureOptions& options);

  int width() const { return width_; }
  int height() const { return height_; }
  /// When the last episode is over.
  EpisodeTime end() const;
  /// The moment that tells most: the first contact; if there is none, the least clearance; without
  /// a truth, the first stop by a supervisor.
  EpisodeTime telling_moment() const;

  /// Of the names that are written on the pictures, those with letters that the font has not, and
  /// that show as '?'.
  std::vector<std::string> names_not_shown() const;

  Image Draw(EpisodeTime t);

 private:
  struct Panel {
    Panel(const GlContext& gl, const NamedRecording& trace, const PixelRect& place,
          const PixelRect& scene);
    TraceModel model;
    ScenePainter painter;
    Title title;
    PixelRect place, scene;             // of the picture; `scene` lies inside `place`
    std::optional<Image> last_picture;  // its last picture, once drawn: it stays
  };

  void ChooseViews(const PictureOptions& options);
  void DrawHeader(Image& image, EpisodeTime t) const;
  void DrawLegend(Image& image) const;
  void DrawPanel(Image& image, Panel& panel, EpisodeTime t) const;
  void DrawSummary(Image& image, const PixelRect& place, EpisodeTime t) const;

  int width_, height_;
  double scale_;  // of everything that is not a scene, 1 for 720 lines
  double playback_speed_;
  std::string heading_;
  Font font_;
  std::list<Panel> panels_;  // never moved: a painter refers to its model
  std::vector<PixelRect> empty_places_;
};

}  // namespace sidestep::render
