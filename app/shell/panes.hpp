// The panes of a window's picture: their cameras, what is drawn for all but the first one, which the window draws
// itself, and what is written over them.
//
//   Panes panes(model);
//   panes.lay_out(choice, area, scale);                 // each picture
//   panes.listen();                                     // the pointer turns cameras
//   draw(panes.options(panes.first().shows), panes.first().area);
//   panes.draw_others({...});                           // one of them each time: a few pictures a second each
//   panes.lay_others(window_height);
//   panes.write_over();
#pragma once

#include <array>
#include <functional>
#include <memory>

#include <trocar/pictures/picture_size.hpp>
#include <trocar/render/backend/backend.hpp>
#include <trocar/view/base/cameras.hpp>
#include <trocar/view/scene/second_scope.hpp>

#include "shell/layout.hpp"
#include "shell/pane_canvas.hpp"

namespace trocar::app {

inline constexpr int kEndoscopeEye = 0, kOutsideEye = 1, kFilmEye = 2, kSecondScopeEye = 3;  ///< exposure memories

/// The window's lower left corner is OpenGL's origin.
render::Target window_target(const Area& area, int window_height);

/// In a pane that is higher than wide: as much to both sides as in a square one, an endoscope's whole circle.
void fit_to(const Area& area, render::Frame& frame);

/// Where the cameras are that hands turn, and what the analysis shows.
struct PaneCameras {
  view::Orbit outside, analysis_orbit;
  view::SecondScope second;
  view::AnalysisOptions analysis;        ///< what its pane shows
  bool analysis_from_endoscope = false;  ///< through the endoscope, not from outside

  friend bool operator==(const PaneCameras&, const PaneCameras&) = default;
};

class Panes {
 public:
  explicit Panes(const sim::Model& model);

  struct Pane {
    PaneShows shows = PaneShows::endoscope;
    Area area;
    bool elsewhere = false;  ///< for the second window: not to be seen in this one
    friend bool operator==(const Pane&, const Pane&) = default;
  };
  PaneCameras cameras;
  std::shared_ptr<const view::OrganBeside> beside;  ///< for analysis.solvers; null: no other solver runs beside

  /// @param elsewhere  size of the second window, where there is one [px]
  void lay_out(const LayoutChoice& choice, const Area& whole, float scale, pictures::PictureSize elsewhere = {0, 0});
  /// What a picture costs beside one picture over all of it.
  double load() const { return m_load; }
  const std::vector<Pane>& panes() const { return m_panes; }
  const Pane& first() const { return m_panes.front(); }

  /// Camera, exposure memory and figures of a pane.
  view::ViewOptions options(PaneShows shows) const;

  /// Turns what a camera looks at, from where it stands, or aims the second scope. [rad]; false: nothing to turn
  bool turn(PaneShows shows, double yaw, double pitch);
  bool shift(PaneShows shows, double right, double up);  ///< in picture heights
  bool closer(PaneShows shows, double by);               ///< > 0: the distance shrinks by exp(-by)
  /// Dragging and the wheel over the panes, in ImGui's open frame. True: a camera was moved.
  bool listen();
  bool dragging() const { return m_dragged >= 0; }
  /// What the pointer is over; nothing outside the panes and over panels.
  const Pane* under_pointer() const;

  /// Where pictures of the others come from.
  struct Source {
    view::SceneView& view;
    render::Backend& backend;
    const sim::State& state;
    std::uint64_t clock = 0;  ///< [ms] for exposure
    render::Quality quality;
    const std::vector<view::PartStyle>& styles;
  };
  /// The next one in turn, and every one that has never been drawn as it is. @param all  every one
  void draw_others(const Source& source, bool all);
  /// The picture of what the second window shows, where it is not the first pane's; null: it is.
  const PaneCanvas* canvas_elsewhere() const;
  view::Legend legend_of_pane(PaneShows shows) const;
  /// Over the first one, in the window. @param mirrored  what endoscopes show
  void lay_others(int window_height, bool mirrored) const;
  /// Names, borders and legends, below panels and menus.
  void write_over(bool names) const;

 private:
  void draw_one(const Source& source, std::size_t i);

  std::vector<Pane> m_panes;
  std::vector<Pane> m_drawn;  ///< (panes) as each was drawn last
  std::vector<PaneCanvas> m_canvas;
  std::size_t m_turn = 0;
  int m_dragged = -1;
  bool m_shifting = false;
  float m_scale = 1;
  double m_load = 1;
};

}  // namespace trocar::app
