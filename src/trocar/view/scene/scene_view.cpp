#include <trocar/sim/stages/visibility.hpp>
#include <trocar/view/base/cameras.hpp>
#include <trocar/view/fluids/lens.hpp>
#include <trocar/view/fluids/smoke_drawing.hpp>
#include <trocar/view/fluids/wet_drawing.hpp>
#include <trocar/view/instruments/metal_drawing.hpp>
#include <trocar/view/objects/object_drawings.hpp>
#include <trocar/view/scene/body_drawing.hpp>
#include <trocar/view/scene/scene_view.hpp>

namespace trocar::view {

using render::DrawItem;

namespace {

/// Grey, dull, without patterns: nothing that could be taken for a figure.
render::Material clay(const render::Material& of) {
  render::Material m;
  m.colour = m.colour_b = m.colour_c = m.tint = {0.07f, 0.07f, 0.072f};
  m.mottle = m.bump = m.wetness = m.glow_amount = m.film_bump = 0;
  m.wrap = {0.2f, 0.2f, 0.2f};
  m.alpha = of.alpha;
  m.rim_alpha = of.rim_alpha;
  m.two_sided = of.two_sided;
  return m;
}

}  // namespace

struct SceneView::Parts {
  const sim::Model& model;
  BodyDrawing body;
  MetalDrawing metal;
  ObjectDrawings objects;
  SceneParts names;
  AnalysisDrawing analysis;
  std::optional<WetDrawing> wet;
  Lens lens;

  Parts(const sim::Model& of, render::Backend& backend)
      : model(of),
        body(of, backend),
        metal(of, body.cavity(), backend),
        objects(of, backend),
        names(of, body.vessel_kinds()),
        analysis(of, backend) {
    if (model.wet.there) wet.emplace(model);
  }
  void aim(const sim::State& state, const ViewOptions& options, render::Frame& frame) const;
  void list(const sim::State& state, const ViewOptions& options, render::Frame& frame);
  void list_analysis(const sim::State& state, const ViewOptions& options, bool with_walls, const Listing& to);
  void list_fluids(const sim::State& state, const ViewOptions& options, render::Frame& frame);
};

/// The camera, its light and its optics.
void SceneView::Parts::aim(const sim::State& state, const ViewOptions& options, render::Frame& frame) const {
  if (options.camera == ViewOptions::Camera::outside) {
    frame.camera = outside_camera(options.eye, options.target, options.up, options.outside_fov);
    frame.light = room_light();
    frame.look = room_look();
    frame.background = {0.09f, 0.10f, 0.11f};
  } else {
    const kinematics::ScopeFrame scope = sim::scope_of(model, state);
    frame.camera = scope_camera(scope, model.scope.field_of_view);
    frame.light.bounce_colour = body.returned();
    kinematics::FulcrumPose shaft = pose_of(state.scope);
    shaft.roll = 0;
    const kinematics::TipFrame tip = kinematics::forward(model.scope.port, shaft);
    frame.look.notch_angle = float(notch_angle(scope, tip, double(state.scope.post)));
  }
  if (options.camera == ViewOptions::Camera::inside) {
    const render::Camera optics = frame.camera;
    frame.camera = outside_camera(options.eye, options.target, options.up, double(optics.vertical_fov));
    frame.camera.near_plane = optics.near_plane;
    frame.camera.far_plane = optics.far_plane;
    frame.look.notch_angle = 0;
  }
  if (!options.analysis.on()) return;
  frame.light = light_for_analysis();
  frame.look = analysis_look();
  frame.background = {0.018f, 0.019f, 0.021f};
}

void SceneView::Parts::list(const sim::State& state, const ViewOptions& options, render::Frame& frame) {
  const bool inside = options.camera != ViewOptions::Camera::outside, measured = options.analysis.on();
  const DetailEye eye(frame.camera, options.picture_height, options.quality, options.eye_index);
  const Listing to{frame, eye};
  const FirstParts& first = names.first;
  if (measured) {
    list_analysis(state, options, inside || options.walls, to);
  } else {
    if (inside) body.list_surroundings(first, to);
    body.list(inside || options.walls, first, to);
  }
  if (!inside)  // the cavity lies open: its walls are drawn where they turn their inner side to the eye
    for (DrawItem& drawn : frame.items)
      if (body.is_wall(drawn.mesh)) drawn.material.two_sided = false;
  objects.list(first.object, to);
  metal.list_clips(state, first, to);
  if (!options.instruments) return;
  metal.list_tools(state, options.styles, first, to);
  if (inside && !measured) metal.list_port_sites(first, to);
  if (!inside || options.second_scope) metal.list_scope(model.scope.port, pose_of(state.scope), first, to);
  if (!inside && options.second_scope)
    metal.list_scope(options.second_scope->port, options.second_scope->pose, first, to);
}

/// Walls as grey clay. Where neither surfaces nor springs show where tissue is, its ghost does.
void SceneView::Parts::list_analysis(const sim::State& state, const ViewOptions& shown, bool with_walls,
                                     const Listing& to) {
  const AnalysisOptions& options = shown.analysis;
  const OrganBeside* beside = options.solvers ? shown.beside.get() : nullptr;
  std::vector<DrawItem>& items = to.frame.items;
  if (with_walls) body.list_walls(names.first, to);
  const std::size_t ghosts = items.size();
  if (!options.strain && !options.springs) body.list(false, names.first, to);
  if (options.pressure) std::erase_if(items, [&](const DrawItem& i) { return names.is_vessel(i.part); });
  if (beside)
    std::erase_if(items, [part = names.of(Measured::organ, std::size_t(beside->organ))](const DrawItem& i) {
      return i.part == part;
    });
  for (std::size_t i = 0; i < items.size(); ++i) {
    items[i].material = clay(items[i].material);
    if (i >= ghosts) items[i].translucent = false, items[i].style = render::DrawStyle::transparent;
  }
  analysis.list(
      state, options, beside, [this](Measured kind, std::size_t i) { return names.of(kind, i); }, to.frame);
}

void SceneView::Parts::list_fluids(const sim::State& state, const ViewOptions& options, render::Frame& frame) {
  const auto shown = [&](std::uint16_t part) { return style_of(options.styles, part) != PartStyle::hidden; };
  frame.liquid.part = names.first.liquid;
  frame.liquid.look = liquid_look({});
  frame.liquid.down = vec_cast<float>(normalised(model.gravity, Vec3d{0, 0, -1}));
  if (shown(names.first.liquid)) body.list_ooze(frame.liquid);
  if (!wet) return;
  if (shown(names.first.liquid)) wet->list(state, frame);
  if (shown(names.first.smoke)) {
    list_smoke(model.wet.model.smoke, state.fluids.smoke, frame);
    list_plumes(model, state, frame);
  }
  // Only the endoscope has a lens that fogs: other cameras look past it.
  if (options.camera == ViewOptions::Camera::scope) lens.list(model.wet.model.smoke, state.fluids.smoke, frame);
}

SceneView::SceneView(const sim::Model& model, render::Backend& backend)
    : m_parts(std::make_unique<Parts>(model, backend)) {}
SceneView::~SceneView() = default;

const std::vector<ScenePart>& SceneView::parts() const { return m_parts->names.list; }

render::Frame SceneView::frame(const sim::State& state, const ViewOptions& options) {
  Parts& p = *m_parts;
  p.body.update(state);
  p.metal.update(state);
  p.objects.update(state);
  render::Frame frame;
  frame.tick = state.tick;
  frame.quality = options.quality;
  frame.eye = options.eye_index;
  frame.metering = options.metering;
  p.aim(state, options, frame);
  p.list(state, options, frame);
  apply(options.styles, frame);
  if (options.analysis.on())  // colours say figures: nothing shades them, and no blood lies over them
    frame.rods.clear();
  else
    p.list_fluids(state, options, frame);
  return frame;
}

}  // namespace trocar::view
