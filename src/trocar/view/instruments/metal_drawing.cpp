#include <algorithm>

#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/sim/model/state.hpp>
#include <trocar/view/base/pinch.hpp>
#include <trocar/view/bodies/cavity.hpp>
#include <trocar/view/bodies/organ_drawing.hpp>
#include <trocar/view/instruments/clip_shape.hpp>
#include <trocar/view/instruments/metal_drawing.hpp>

namespace trocar::view {

using render::DrawItem;

namespace {

constexpr double kSleeveShows = 0.018;  // [m] of a trocar's sleeve inside the wall
constexpr float kBeforeFold = 1.2e-3f;  // [m] that a clip is drawn nearer
constexpr float kInJaws = 0.5f;         // share of the light that comes between open jaws
constexpr double kInGroove = 0.00025;   // [m] that the legs of a loaded clip lie below the faces of the jaws

render::Mat4 to_world(const Placement& p) { return render::placement(p.rotation, p.translation); }

/// How much of Paint's blood and burn is on a hand's instrument, 0..1. It passed a bleeding wall; each grip that
/// slipped, each cut and each vessel that opened adds to it, and current burns it on. A box does not bleed.
float soil_on(const sim::Model& model, const sim::State& state, std::size_t hand) {
  constexpr double kPassedTheWall = 0.8, kSlip = 0.06, kHold = 0.1, kCut = 0.07, kOpened = 0.2, kScar = 0.004;
  if (!is_alive(wall_look(model))) return 0;
  const interactions::ToolState& tool = state.tools[hand];
  double soil = kPassedTheWall + kSlip * std::min(tool.slipped, 4) + (tool.holds > 0 ? kHold : 0);
  soil += kCut * std::min(state.cut_count, 5) + kOpened * std::min(state.opening_count, 2);
  soil += kScar * std::min(state.scarred_count, 60);
  return float(std::min(1.0, soil));
}

/// Does a fold hang where that clip lies, or does its vessel run in one?
bool in_fold(const interactions::Clip& clip, const sim::Model& model) {
  const auto hangs_there = [&](const auto& fold) {
    return fold.strand == clip.strand && clip.s >= fold.from && clip.s <= fold.to;
  };
  if (clip.on_thread()) return false;
  return clip.strand < 0 || std::any_of(model.drawn_folds.begin(), model.drawn_folds.end(), hangs_there) ||
         std::any_of(model.membranes.begin(), model.membranes.end(), hangs_there);
}

/// 0..1: from where a touch pales tissue to where it has given all its blood.
float pressure_of(const interactions::ToolState& tool) {
  const Vec3d force{tool.contact_force[0], tool.contact_force[1], tool.contact_force[2]};
  return float(smooth(0.02, 0.6, length(force)));
}

}  // namespace

MetalDrawing::MetalDrawing(const sim::Model& model, const MeshBuffer& cavity, render::Backend& backend)
    : m_model(&model),
      m_lining(lining(look(model, "peritoneum").material, model)),
      m_clip_detail(levels_of(model, "clips")),
      m_titanium(&look(model, "titanium")) {
  std::vector<PiercedWall> pierced;
  std::vector<std::vector<std::uint32_t>> indices;
  for (const sim::WallModel& w : model.walls) indices.push_back(flat_indices(w.skin));
  for (std::size_t i = 0; i < model.walls.size(); ++i) {
    const sim::WallModel& w = model.walls[i];
    pierced.push_back({w.skin.rest, w.skin.rest_normal, indices[i], w.look});
  }
  pierced.push_back({cavity.positions, cavity.normals, cavity.indices,
                     model.walls.empty() ? "peritoneum" : model.walls.front().look});
  const sim::State start = sim::initial_state(model);
  for (std::size_t h = 0; h < model.hands.size(); ++h) make_hand(h, pierced, start, backend);
  m_scope = made(scope_parts(model.scope.shaft_radius), Detail(levels_of(model, "endoscope")), backend);
}

std::vector<MetalDrawing::DrawnPart> MetalDrawing::made(const std::vector<InstrumentPart>& parts, const Detail& detail,
                                                        render::Backend& backend) {
  std::vector<DrawnPart> drawn;
  for (const InstrumentPart& p : parts)
    drawn.push_back({p.joint, &look(*m_model, p.look), rigid(p.mesh, detail, backend), detail, p.link});
  return drawn;
}

void MetalDrawing::make_hand(std::size_t h, const std::vector<PiercedWall>& pierced, const sim::State& start,
                             render::Backend& backend) {
  const sim::HandModel& hand = m_model->hands[h];
  auto& drawn = m_tools.emplace_back();
  double widest = 0;
  for (const interactions::ToolModel& tool : hand.rack) widest = std::max(widest, tool.shaft_radius);
  const Vec3d axis = kinematics::forward(hand.port, start.tools[h].pose()).axis();
  m_port_details.emplace_back(levels_of(*m_model, "cavity"));
  m_port_sites.emplace_back(hand.port, axis, widest + kSleeveWall, pierced, backend, m_port_details.back());
  const double wall = m_port_sites.back().depth();
  m_sleeve_radius.push_back(widest);
  m_sleeve_end.push_back(kSleeveShows + std::max(0.0, wall));
  const Detail sleeve(levels_of(*m_model, hand.name));
  m_sleeves.push_back(made(sleeve_parts(widest, m_sleeve_end.back(), wall), sleeve, backend));
  for (const interactions::ToolModel& tool : hand.rack) {
    drawn.push_back(made(instrument_parts(tool), Detail(levels_of(*m_model, tool.name)), backend));
    if (tool.clip_length <= 0 || tool.clips <= 0) continue;
    m_loaded.push_back(
        {int(h), int(drawn.size()) - 1, {backend, clip_shape(tool.clip_length, tool.parallel_gap).data()}});
    if (m_clips.count(tool.clip_length) == 0)
      m_clips.emplace(tool.clip_length, rigid(clip_shape(tool.clip_length, 0), m_clip_detail, backend));
  }
}

/// How far the jaws look open: no further than a sleeve lets them in which they still are.
double MetalDrawing::drawn_aperture(const sim::State& state, std::size_t hand) const {
  const interactions::ToolState& tool = state.tools[hand];
  const interactions::ToolModel& of = m_model->tool(state, hand);
  const interactions::ToolShape shape = sim::shape_of(*m_model, state, hand);
  const double beyond = m_sleeve_end[hand] - dot(shape.pivot - sim::port_of(*m_model, state, hand), shape.shaft.axis());
  return std::min(tool.aperture, aperture_in_sleeve(of, beyond, m_sleeve_radius[hand]));
}

interactions::ToolShape MetalDrawing::shape_in_trocar(const sim::State& state, std::size_t hand) const {
  return shape_of(m_model->tool(state, hand), state.tools[hand].pose(), sim::joints_of(state, hand),
                  drawn_aperture(state, hand), sim::port_shift(state, hand));
}

void MetalDrawing::update(const sim::State& state) {
  for (std::size_t h = 0; h < m_port_sites.size(); ++h)
    m_port_sites[h].update(kinematics::forward(m_model->hands[h].port, state.tools[h].pose()).axis());
  for (LoadedClip& l : m_loaded) {
    if (state.tools[std::size_t(l.hand)].instrument != l.instrument) continue;
    const interactions::ToolModel& tool = m_model->tool(state, std::size_t(l.hand));
    const double open = tool.parallel_gap * drawn_aperture(state, std::size_t(l.hand));
    const MeshBuffer shape = clip_shape(tool.clip_length, std::max(0.0, open - 2 * kClipHalfGap + 2 * kInGroove));
    l.mesh.move(shape.positions, {});
  }
}

void MetalDrawing::list_port_sites(const FirstParts& first, const Listing& to) {
  for (std::size_t h = 0; h < m_port_sites.size(); ++h) {
    const PortSite& site = m_port_sites[h];
    if (!site.mesh().id) continue;
    render::DrawItem tent = item(site.mesh(), look(*m_model, site.look()), first.cavity);
    tent.material.middle = m_lining.middle;
    tent.material.fibre_axis = m_lining.fibre_axis;
    to.add(tent, m_port_details[h], site.buffer().positions);
  }
}

void MetalDrawing::list_clips(const sim::State& state, const FirstParts& first, const Listing& to) {
  const sim::Model& model = *m_model;
  for (int i = 0; i < state.clip_count; ++i) {
    const interactions::Clip& c = state.clips[std::size_t(i)];
    if (c.dropped() || c.strand >= int(model.strands.size()) || c.vessel > int(model.vessels.list.size())) continue;
    if (m_clips.empty()) continue;
    const auto known = m_clips.find(c.length), mesh = known == m_clips.end() ? m_clips.begin() : known;
    const ClipPress at = c.on_thread() ? press_on_thread(c, i, state) : press_of(c, model, state);
    if (!(at.radius > 0)) continue;
    const Mat3f turn =
        Mat3f::from_columns(vec_cast<float>(at.open), vec_cast<float>(at.normal), vec_cast<float>(at.axis));
    DrawItem drawn = item({}, *m_titanium, first.clips);
    const Vec3f bend = vec_cast<float>(at.centre + at.low * at.axis);
    // Its legs pinch the fold beside the tube, too, which is whole in the simulation and would lie over them.
    const float before = in_fold(c, model) ? kBeforeFold : 0;
    const Vec3f before_fold = before * normalised(to.frame.camera.position - bend, Vec3f{});
    drawn.transform = to_world({turn, bend + before_fold});
    to.add(mesh->second, drawn, m_clip_detail);
  }
}

void MetalDrawing::list_tools(const sim::State& state, const std::vector<PartStyle>& styles, const FirstParts& first,
                              const Listing& to) {
  for (std::size_t h = 0; h < m_tools.size(); ++h) {
    list_hand(state, h, first, to);
    if (style_of(styles, std::uint16_t(first.tool + h)) == PartStyle::shaded) list_rods(state, h, to.frame);
    list_loaded(state, h, first, to);
  }
}

void MetalDrawing::list_hand(const sim::State& state, std::size_t h, const FirstParts& first, const Listing& to) {
  const interactions::ToolShape shape = shape_in_trocar(state, h);
  const float soil = soil_on(*m_model, state, h);
  const Placement axis = placement_of(InstrumentPart::Joint::shaft, shape);
  for (DrawnPart& part : m_sleeves[h]) {
    DrawItem drawn = item({}, *part.look, first.tool + h);
    drawn.transform = to_world({axis.rotation, vec_cast<float>(sim::port_of(*m_model, state, h))});
    to.add(part.drawn, drawn, part.detail);
  }
  for (DrawnPart& part : m_tools[h][std::size_t(state.tools[h].instrument)]) {
    DrawItem drawn = item({}, *part.look, first.tool + h);
    const bool works = part.joint == InstrumentPart::Joint::works;
    drawn.transform =
        to_world(works ? placement_of_works(m_model->tool(state, h), shape, part.link, drawn_aperture(state, h))
                       : placement_of(part.joint, shape, part.link));
    drawn.material.soil = soil;
    to.add(part.drawn, drawn, part.detail);
  }
}

void MetalDrawing::list_rods(const sim::State& state, std::size_t h, render::Frame& frame) const {
  const interactions::ToolShape shape = shape_in_trocar(state, h);
  const float pressed = pressure_of(state.tools[h]);
  for (int k = interactions::kShaft; k < end_of(shape); k = interactions::next(k)) {  // a jaw is wider than it is thick
    const collision::Capsule& rod = shape.rod(k);
    const bool jaw = interactions::is_jaw(k);
    const double half = jaw ? std::max(rod.radius, 0.3 * m_model->tool(state, h).jaw_width) : rod.radius;
    frame.rods.push_back({vec_cast<float>(rod.a), vec_cast<float>(rod.b), float(half), jaw ? pressed : 0});
  }
}

void MetalDrawing::list_loaded(const sim::State& state, std::size_t h, const FirstParts& first,
                               const Listing& to) const {
  const interactions::ToolState& tool = state.tools[h];
  for (const LoadedClip& l : m_loaded) {
    if (l.hand != int(h) || l.instrument != tool.instrument || tool.clips_left <= 0) continue;
    if (!tool.armed && tool.aperture < 0.5) continue;  // the one that was there has just been set
    Placement place = placement_of(InstrumentPart::Joint::body, shape_in_trocar(state, h));
    place.translation += float(clip_seat(m_model->tool(state, h))) * place.rotation.column(2);
    DrawItem drawn = item(l.mesh.handle(), *m_titanium, first.tool + h);
    drawn.transform = to_world(place);
    const float lit =
        1 - (1 - kInJaws) * float(smooth(0, 0.6, tool.aperture));  // closed, as it is when it has been set
    for (Vec3f* c : {&drawn.material.colour, &drawn.material.colour_b, &drawn.material.colour_c}) *c = lit * *c;
    to.add(drawn);
  }
}

void MetalDrawing::list_scope(Vec3d port, const kinematics::FulcrumPose& pose, const FirstParts& first,
                              const Listing& to) {
  const kinematics::TipFrame tip = kinematics::forward(port, pose);
  Placement place;
  const Vec3d x = tip.opening(), z = tip.axis();
  place.rotation = Mat3f::from_columns(vec_cast<float>(x), vec_cast<float>(cross(z, x)), vec_cast<float>(z));
  place.translation = vec_cast<float>(tip.tip);
  for (DrawnPart& part : m_scope) {
    DrawItem drawn = item({}, *part.look, first.scope);
    drawn.transform = to_world(place);
    to.add(part.drawn, drawn, part.detail);
  }
}

}  // namespace trocar::view
