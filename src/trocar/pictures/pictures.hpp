// Pictures of a State without a window: what --shots, --video and gallery draw with.
//
//   Pictures pictures(model, {800, 600});
//   render::write_png("a.png", pictures.draw(state));
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <trocar/core/json.hpp>
#include <trocar/pictures/legend_drawing.hpp>
#include <trocar/pictures/picture_size.hpp>
#include <trocar/pictures/shown_parts.hpp>
#include <trocar/pictures/two_eyes.hpp>
#include <trocar/render/backend/backend.hpp>
#include <trocar/view/scene/scene_view.hpp>

namespace trocar::render {
class GlContext;
}

namespace trocar::pictures {

/// What all pictures of a run have in common.
struct PictureLook {
  TwoEyes eyes;
  ShownParts shown;
  view::AnalysisOptions analysis = {};  ///< its legend is drawn into the picture
};

class Pictures {
 public:
  /// @throws core::EnvironmentLacks without OpenGL
  Pictures(const sim::Model& model, PictureSize size, const PictureLook& look = {});
  ~Pictures();

  /// The next picture of a stream (exposure follows the scene as a camera's does).
  render::Image draw(const sim::State& state, view::ViewOptions options = {});
  /// A single picture: as draw(), with the exposure settled. Does not disturb the stream's exposure.
  render::Image still(const sim::State& state, view::ViewOptions options = {});
  /// What draw() draws.
  render::Frame frame(const sim::State& state, view::ViewOptions options);
  render::Backend& backend() { return *m_backend; }
  /// Of pictures whose own options ask for none; for those who draw several ways.
  void set_analysis(const view::AnalysisOptions& analysis) { m_analysis = analysis; }
  const std::string& driver() const;
  const std::vector<view::ScenePart>& parts() const { return m_view->parts(); }

 private:
  void choose(view::ViewOptions& options) const;
  render::Image read(const view::ViewOptions& options);

  PictureSize m_size;
  TwoEyes m_eyes;
  std::unique_ptr<render::GlContext> m_context;
  std::unique_ptr<render::Backend> m_backend;
  std::unique_ptr<view::SceneView> m_view;
  std::vector<view::PartStyle> m_styles;
  view::AnalysisOptions m_analysis;
  LegendPainter m_legend;
};

/// Numbered PNG files that say what they show, and index.json.
class Shots {
 public:
  /// Creates the folder. @param only  pictures whose name has this; the others are counted, but not drawn
  /// @throws core::EnvironmentLacks
  Shots(Pictures& pictures, const std::filesystem::path& folder, std::string only = {});

  /// "007-clipped.png" or so; `text` goes to the index. Beyond kMaxShots nothing more is drawn (and the index says so).
  void take(const sim::State& state, const std::string& what, const std::string& text);
  void take_outside(const sim::State& state, const std::string& what, const std::string& text,
                    const view::ViewOptions& options);
  /// A picture that somebody else drew.
  void take_image(const sim::State& state, const std::string& what, const std::string& text,
                  const render::Image& image);
  bool wants(const std::string& what) const { return what.find(m_only) != std::string::npos; }
  void write_index() const;
  const std::vector<std::string>& files() const { return m_files; }
  std::string index_file() const { return (m_folder / "index.json").string(); }

  static constexpr int kMaxShots = 200;

 private:
  bool skips(const std::string& what);  ///< a picture that is not wanted, or one too many
  void write(const sim::State& state, const std::string& what, const std::string& text, const render::Image& image);

  Pictures& m_pictures;
  std::filesystem::path m_folder;
  std::string m_only;
  int m_next = 0;  ///< number of a picture, drawn or not
  std::vector<std::string> m_files;
  Json m_index = Json::array();
  int m_left_out = 0;
};

}  // namespace trocar::pictures
