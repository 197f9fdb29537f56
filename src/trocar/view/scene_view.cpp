#include <algorithm>
#include <map>
#include <optional>

#include <trocar/render/mesh_arrays.hpp>
#include <trocar/render/openness.hpp>
#include <trocar/sim/visibility.hpp>
#include <trocar/view/adhesions.hpp>
#include <trocar/view/analysis_drawing.hpp>
#include <trocar/view/bowel_loops.hpp>
#include <trocar/view/cameras.hpp>
#include <trocar/view/cavity.hpp>
#include <trocar/view/clip_shape.hpp>
#include <trocar/view/cuttable_drawing.hpp>
#include <trocar/view/detail.hpp>
#include <trocar/view/drape.hpp>
#include <trocar/view/fat_tags.hpp>
#include <trocar/view/instrument_shapes.hpp>
#include <trocar/view/joint.hpp>
#include <trocar/view/lens.hpp>
#include <trocar/view/looks.hpp>
#include <trocar/view/membrane_drawing.hpp>
#include <trocar/view/omentum.hpp>
#include <trocar/view/organ_drawing.hpp>
#include <trocar/view/port_site.hpp>
#include <trocar/view/pouch_drawing.hpp>
#include <trocar/view/ridge.hpp>
#include <trocar/view/scene_view.hpp>
#include <trocar/view/sheet_drawing.hpp>
#include <trocar/view/smoke_drawing.hpp>
#include <trocar/view/tube_drawing.hpp>
#include <trocar/view/vessel_drawing.hpp>
#include <trocar/view/wall_surface.hpp>
#include <trocar/view/wet_drawing.hpp>

namespace trocar::view {

using render::DrawItem;
using render::Frame;

namespace {

constexpr double kSleeveShows = 0.018;                      // [m] of a trocar's sleeve inside the wall
constexpr float kVesselBefore = 0.0016f;                    // [m] a fold's vessels are drawn nearer than they are
constexpr float kClipThroughFold = 0.75f;                   // how much of a clip shows through a sheer fold
constexpr float kShadeCell = 0.001f, kShadeReach = 0.018f;  // [m] what shades what

/// A mesh that does not bend.
struct RigidMesh {
  OwnedMesh mesh;
  std::vector<Vec3f> points;  ///< of it
};
RigidMesh rigid(MeshBuffer shape, const Detail& detail, render::Backend& backend) {
  coarsen(shape, detail, kRigid);
  return {{backend, shape.data()}, std::move(shape.positions)};
}

/// A rigid part of an instrument and its mesh.
struct DrawnPart {
  InstrumentPart::Joint joint;
  const Look* look;
  RigidMesh drawn;
  Detail detail;
};

std::vector<DrawnPart> made(const std::vector<InstrumentPart>& parts, const Detail& detail, render::Backend& backend) {
  std::vector<DrawnPart> drawn;
  for (const InstrumentPart& p : parts)
    drawn.push_back({p.joint, &look(p.look), rigid(p.mesh, detail, backend), detail});
  return drawn;
}

render::Mat4 to_world(const Placement& p) { return render::placement(p.rotation, p.translation); }

DrawItem item(render::MeshHandle mesh, const Look& look, std::size_t part) {
  DrawItem i;
  i.mesh = mesh;
  i.part = std::uint16_t(part);
  i.material = look.material;
  i.translucent = look.translucent;
  return i;
}

/// The look's unevenness, and a rise where each strand grows out.
Relief relief_of(int organ, const sim::Model& model) {
  Relief relief = look(model.organ_look(organ)).relief;
  for (std::size_t i = 0; i < model.strands.size(); ++i) {
    const sim::StrandModel& strand = model.strands[i];
    const std::vector<Vec3d>& rest = model.bodies[i].model.rest;
    const auto hangs = [&](const sim::StrandEndModel& end) {
      return end.kind == sim::StrandEndModel::hosted && end.organ == organ;
    };
    if (hangs(strand.start)) relief.roots.push_back({rest.front(), strand.outer.front()});
    if (hangs(strand.end)) relief.roots.push_back({rest.back(), strand.outer.back()});
  }
  return relief;
}

PartStyle style_of(const std::vector<PartStyle>& styles, std::uint16_t part) {
  return part > 0 && part <= styles.size() ? styles[part - std::size_t(1)] : PartStyle::shaded;
}

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

/// How much of Paint's blood and burn is on a hand's instrument, 0..1. It passed a bleeding wall; each grip that
/// slipped, each cut and each vessel that opened adds to it, and current burns it on.
float soil_on(const sim::State& state, std::size_t hand) {
  constexpr double kPassedTheWall = 0.48, kSlip = 0.06, kHold = 0.1, kCut = 0.07, kOpened = 0.2, kScar = 0.004;
  const interactions::ToolState& tool = state.tools[hand];
  double soil = kPassedTheWall + kSlip * std::min(tool.slipped, 4) + (tool.holds > 0 ? kHold : 0);
  soil += kCut * std::min(state.cut_count, 5) + kOpened * std::min(state.opening_count, 2);
  soil += kScar * std::min(state.scarred_count, 60);
  return float(std::min(1.0, soil));
}

/// 0..1: from where a touch pales tissue to where it has given all its blood.
float pressure_of(const interactions::ToolState& tool) {
  const Vec3d force{tool.contact_force[0], tool.contact_force[1], tool.contact_force[2]};
  return float(smooth(0.02, 0.6, length(force)));
}

/// The clip that lies ready in an applier's jaws.
struct LoadedClip {
  int hand = -1, instrument = -1;  ///< of the hand's rack
  OwnedMesh mesh;
};

/// Arteries or veins, in folds or elsewhere.
struct DrawnVessels {
  VesselDrawing drawing;
  bool in_a_fold = false;
  std::size_t look = 0;  ///< its number among the scene's
};

/// Where a strand's end grows out of an organ.
struct TubeJoint {
  std::size_t tube = 0;
  int organ = -1;  ///< -1: a wall
  Joint joint;
};

}  // namespace

struct SceneView::Parts {
  const sim::Model& model;
  std::vector<OrganDrawing> organs;  ///< solids
  std::vector<CuttableDrawing> cuttables;
  std::vector<HeatMarks> burns, cuttable_burns;  ///< (organs)
  std::vector<FatTags> fat;
  std::vector<int> fat_on;  ///< its organ
  std::vector<Drape> drapes;
  std::vector<const Look*> drape_look;
  std::vector<TubeDrawing> tubes;
  std::vector<TubeJoint> joints;
  std::optional<Adhesions> adhesions;
  std::vector<Ridge> ridges;
  std::vector<std::size_t> ridge_of;  ///< their strands
  std::vector<SheetDrawing> sheets;
  std::vector<MembraneDrawing> membranes;
  std::vector<PouchDrawing> pouches;
  std::vector<DrawnVessels> vessels;
  std::vector<const Look*> vessel_look;
  std::optional<WetDrawing> wet;
  Lens lens;
  AnalysisDrawing analysis;
  std::vector<std::size_t> membrane_of, pouch_of;  ///< their numbers in the Model
  std::vector<OwnedMesh> walls, aprons;
  std::vector<std::size_t> apron_on;  ///< walls
  std::vector<RigidMesh> margins;
  std::vector<MeshBuffer> margin_shapes;
  RigidMesh cavity;
  OwnedMesh loops;
  std::vector<std::vector<std::vector<DrawnPart>>> tools;  ///< (hands, rack)
  std::vector<std::vector<DrawnPart>> sleeves;             ///< (hands)
  std::vector<PortSite> port_sites;                        ///< (hands)
  std::vector<double> sleeve_end, sleeve_radius;           ///< (hands) from the port; inside [m]
  std::vector<DrawnPart> scope;
  std::vector<LoadedClip> loaded;
  std::map<double, OwnedMesh> clips;  ///< closed ones, by their length [m]
  struct Details {                    ///< of what is numbered as above
    std::vector<Detail> organs, cuttables, fat, tubes, sheets, membranes, pouches, vessels, walls, margins;
    Detail cavity;
  } details;
  std::optional<DetailEye> eye;       ///< of the frame
  std::vector<std::int32_t> in_jaws;  ///< bodies that are held (interactions::Hold::body)
  const Look* titanium = &look("titanium");
  std::vector<ScenePart> parts;
  struct FirstParts {  ///< the numbers of the first of each kind, from 1 on
    std::uint16_t organ = 0, tube = 0, fold = 0, membrane = 0, vessel = 0, wall = 0, tool = 0;
    std::uint16_t cavity = 0, scope = 0, clips = 0, liquid = 0, smoke = 0;
  } first;

  Parts(const sim::Model& of, render::Backend& backend);
  void make_tissues(render::Backend& backend);
  void make_metal(render::Backend& backend);
  void name_parts();
  interactions::ToolShape shape_in_trocar(const sim::State& state, std::size_t hand) const;
  double drawn_aperture(const sim::State& state, std::size_t hand) const;
  void update(const sim::State& state);
  /// As fine as its distance asks for; `whole`: with all its triangles, which burns, dents and what jaws do to it need.
  DrawItem& list(DrawItem item, Detail& detail, std::span<const Vec3f> points, Frame& frame, bool whole = false) const;
  bool held(std::size_t body) const;
  DrawItem& list_rigid(const RigidMesh& mesh, DrawItem item, Detail& detail, Frame& frame) const;
  void list_surroundings(Frame& frame);
  void list_tissues(bool with_walls, Frame& frame);
  void list_port_sites(Frame& frame) const;
  void list_clips(const sim::State& state, Frame& frame) const;
  void list_tools(const sim::State& state, const ViewOptions& options, Frame& frame);
  void list_scope(Vec3d port, const kinematics::FulcrumPose& pose, Frame& frame);
  void list_analysis(const sim::State& state, const AnalysisOptions& options, bool with_walls, Frame& frame);
  std::uint16_t part_of(BodyKind kind, std::size_t i) const;
};

SceneView::Parts::Parts(const sim::Model& of, render::Backend& backend) : model(of), analysis(of, backend) {
  make_tissues(backend);
  make_metal(backend);
  name_parts();
}

void SceneView::Parts::name_parts() {
  const auto add = [this](const std::string& name, PartGroup group) {
    parts.push_back({name, group});
    return std::uint16_t(parts.size());
  };
  const auto begins = [this] { return std::uint16_t(parts.size() + 1); };
  first.organ = begins();
  for (int i = 0; i < model.organs(); ++i) add(model.organ_name(i), PartGroup::organs);
  first.tube = begins();
  for (const sim::StrandModel& s : model.strands) add(s.name, PartGroup::tubes);
  first.fold = begins();
  for (const sim::SheetModel& s : model.sheets) add(s.name, PartGroup::folds);
  first.membrane = begins();
  for (const sim::MembraneModel& m : model.membranes)  // a closed one is a hollow organ
    add(m.name, m.sheet.closed() ? PartGroup::organs : PartGroup::folds);
  first.vessel = begins();
  for (const Look* l : vessel_look) add(l == &look("vein") ? "veins" : "arteries", PartGroup::vessels);
  first.wall = begins();
  for (const sim::WallModel& w : model.walls) add(w.name, PartGroup::walls);
  first.cavity = add("cavity", PartGroup::walls);
  first.tool = begins();
  for (const sim::HandModel& h : model.hands) add(h.name, PartGroup::instruments);
  first.scope = add("endoscope", PartGroup::instruments);
  first.clips = add("clips", PartGroup::clips);
  if (!model.wet.there) return;
  first.liquid = add("blood and water", PartGroup::fluids);
  first.smoke = add("smoke", PartGroup::fluids);
}

/// Everything shades everything else, as drawn.
void SceneView::Parts::make_tissues(render::Backend& backend) {
  const WallSurface wall_surface(model);
  for (int i = 0; i < int(model.strands.size()); ++i) {
    details.tubes.emplace_back(levels_of(model, model.strands[std::size_t(i)].name));
    tubes.emplace_back(model, i, details.tubes.back(), &wall_surface);
  }
  std::vector<std::vector<std::uint32_t>> indices;
  std::vector<render::Occluder> occluders;
  for (const sim::SolidModel& s : model.solids) indices.push_back(flat_indices(s.fine));
  for (const sim::WallModel& w : model.walls) indices.push_back(flat_indices(w.skin));
  for (std::size_t i = 0; i < model.solids.size(); ++i) occluders.push_back({model.solids[i].fine.rest, indices[i]});
  for (std::size_t i = 0; i < model.walls.size(); ++i)
    occluders.push_back({model.walls[i].skin.rest, indices[model.solids.size() + i]});
  for (int i = 0; i < int(model.cuttables.size()); ++i)
    cuttables.emplace_back(model.cuttables[std::size_t(i)], relief_of(int(model.solids.size()) + i, model), backend);
  for (const CuttableDrawing& c : cuttables) occluders.push_back({c.positions(), c.indices()});
  for (const TubeDrawing& t : tubes) occluders.push_back({t.drawn().positions, t.drawn().indices});
  const render::OpennessBaker baker(occluders, kShadeCell, kShadeReach);

  for (CuttableDrawing& c : cuttables) {
    details.cuttables.emplace_back(levels_of(model, model.cuttables[cuttable_burns.size()].name));
    const std::size_t organ = model.solids.size() + cuttable_burns.size();
    cuttable_burns.emplace_back(model, interactions::kSolidBase + std::int32_t(organ));
    c.shade(baker);
  }
  for (const sim::SolidModel& s : model.solids) {
    std::vector<Paint> paint(s.fine.rest.size());
    baker.bake(s.fine.rest, s.fine.rest_normal, paint);
    burns.emplace_back(model, interactions::kSolidBase + std::int32_t(organs.size()), below_skin(s.fine));
    details.organs.emplace_back(levels_of(model, s.name));
    organs.emplace_back(s, relief_of(int(organs.size()), model), std::move(paint), backend, details.organs.back());
  }
  for (int i = 0; i < int(organs.size()); ++i) {
    const sim::SolidModel& solid = model.solids[std::size_t(i)];
    const int count = look(solid.look).fat_tags;
    if (count == 0) continue;
    details.fat.emplace_back(levels_of(model, solid.name));
    fat.emplace_back(organs[std::size_t(i)], solid, count, model.gravity, backend, details.fat.back());
    fat_on.push_back(i);
  }
  for (int i = 0; i < int(organs.size()); ++i) {
    const Look& covered = look(model.solids[std::size_t(i)].look);
    if (!covered.draped) continue;
    drapes.emplace_back(model, i, organs, backend);
    drape_look.push_back(&look(model.walls.empty() ? covered.name : model.walls.front().look));
  }
  adhesions.emplace(organs, model, wall_surface, backend);
  for (std::size_t i = 0; i < model.walls.size(); ++i) {
    const tissue::Skin& skin = model.walls[i].skin;
    std::vector<Paint> paint(skin.rest.size());
    baker.bake(skin.rest, skin.rest_normal, paint);
    for (std::size_t v = 0; v < paint.size(); ++v) paint[v].tint = to_byte(fat_below(vec_cast<double>(skin.rest[v])));
    const std::vector<std::uint32_t>& triangles = indices[model.solids.size() + i];
    details.walls.emplace_back(levels_of(model, model.walls[i].name));
    details.margins.push_back(details.walls.back());
    margin_shapes.push_back(around_wall(model, skin, paint));
    margins.push_back(rigid(margin_shapes.back(), details.margins.back(), backend));
    const auto coarser = coarser_lists(skin.rest, triangles, paint, details.walls.back(), kRigid);
    walls.emplace_back(backend, render::MeshData{.positions = skin.rest,
                                                 .normals = skin.rest_normal,
                                                 .rest = {},
                                                 .paint = paint,
                                                 .indices = triangles,
                                                 .coarser = coarser});
  }
  for (std::size_t i = 0; i < model.walls.size(); ++i) {
    if (!look(model.walls[i].look).omentum) continue;
    const MeshBuffer apron = omentum_on(model.walls[i].skin, model.gravity);
    if (apron.size() == 0) continue;
    aprons.emplace_back(backend, apron.data());
    apron_on.push_back(i);
  }
  details.cavity = Detail(levels_of(model, "cavity"));
  cavity = rigid(cavity_around(model), details.cavity, backend);
  if (const MeshBuffer shape = bowel_loops(model, wall_surface); shape.size() > 0)
    loops = OwnedMesh(backend, shape.data());
  for (TubeDrawing& t : tubes) {
    std::vector<Paint> paint(t.drawn().positions.size());
    baker.bake(t.drawn().positions, t.drawn().normals, paint);
    t.create(std::move(paint), backend);
  }
  for (std::size_t i = 0; i < tubes.size(); ++i)
    for (const bool at_start : {true, false}) {
      if (tubes[i].neck(at_start).far <= 0) continue;
      const sim::StrandEndModel& end = at_start ? model.strands[i].start : model.strands[i].end;
      if (end.kind != sim::StrandEndModel::hosted) {
        joints.push_back({i, -1, Joint(tubes[i], at_start, wall_surface, backend)});
        continue;
      }
      const auto organ = std::size_t(end.organ);
      joints.push_back({i, end.organ, Joint(tubes[i], at_start, organs[organ], model.solids[organ].fine, backend)});
    }
  for (std::size_t i = 0; i < tubes.size() && !model.walls.empty(); ++i) {
    const sim::StrandModel& strand = model.strands[i];
    if (strand.start.kind != sim::StrandEndModel::hosted || strand.end.kind != sim::StrandEndModel::fixed) continue;
    ridges.emplace_back(model, tubes[i], int(i), wall_surface, backend);
    ridge_of.push_back(i);
  }
  for (int i = 0; i < int(model.sheets.size()); ++i) {
    details.sheets.emplace_back(levels_of(model, model.sheets[std::size_t(i)].name));
    sheets.emplace_back(model, i, backend, details.sheets.back(), &wall_surface);
  }
  for (const bool veins : {false, true}) {
    using Lie = VesselDrawing::Lie;
    const auto some = [&](bool fold) {
      return std::any_of(model.vessels.list.begin(), model.vessels.list.end(),
                         [&](const sim::Vessel& v) { return v.vein == veins && in_a_fold(v.path) == fold; });
    };
    if (!some(false) && !some(true)) continue;
    const Detail detail(levels_of(model, veins ? "veins" : "arteries"));
    vessel_look.push_back(&look(veins ? "vein" : "artery"));
    for (const bool fold : {false, true}) {
      if (!some(fold)) continue;
      details.vessels.push_back(detail);
      vessels.push_back({VesselDrawing(model, veins, backend, detail, fold ? Lie::in_a_fold : Lie::elsewhere), fold,
                         vessel_look.size() - 1});
    }
  }
  for (std::size_t i = 0; i < model.membranes.size(); ++i) {
    const Detail detail(levels_of(model, model.membranes[i].name));
    if (model.membranes[i].sheet.closed()) {
      pouches.emplace_back(model, int(i), backend, detail);
      details.pouches.push_back(detail);
      pouch_of.push_back(i);
    } else {
      membranes.emplace_back(model, int(i), backend, detail);
      details.membranes.push_back(detail);
      membrane_of.push_back(i);
    }
  }
}

void SceneView::Parts::make_metal(render::Backend& backend) {
  std::vector<PiercedWall> pierced;
  std::vector<std::vector<std::uint32_t>> indices;
  for (const sim::WallModel& w : model.walls) indices.push_back(flat_indices(w.skin));
  for (std::size_t i = 0; i < model.walls.size(); ++i) {
    const sim::WallModel& w = model.walls[i];
    pierced.push_back({w.skin.rest, w.skin.rest_normal, indices[i], w.look});
  }
  for (const MeshBuffer& m : margin_shapes) pierced.push_back({m.positions, m.normals, m.indices, "peritoneum"});
  MeshBuffer around = cavity_around(model);
  render::vertex_normals(around.positions, around.indices, around.normals);
  pierced.push_back({around.positions, around.normals, around.indices, "peritoneum"});
  const sim::State start = sim::initial_state(model);
  for (std::size_t h = 0; h < model.hands.size(); ++h) {
    auto& drawn = tools.emplace_back();
    double widest = 0;
    for (const interactions::ToolModel& tool : model.hands[h].rack) widest = std::max(widest, tool.shaft_radius);
    const Vec3d axis = kinematics::forward(model.hands[h].port, start.tools[h].pose()).axis();
    port_sites.emplace_back(model.hands[h].port, axis, widest + kSleeveWall, pierced, backend);
    const double wall = port_sites.back().depth();
    sleeve_radius.push_back(widest);
    sleeve_end.push_back(kSleeveShows + std::max(0.0, wall));
    const Detail sleeve(levels_of(model, model.hands[h].name));
    sleeves.push_back(made(sleeve_parts(widest, sleeve_end.back(), wall), sleeve, backend));
    for (const interactions::ToolModel& tool : model.hands[h].rack) {
      drawn.push_back(made(instrument_parts(tool), Detail(levels_of(model, tool.name)), backend));
      if (tool.clip_length <= 0 || tool.clips <= 0) continue;
      loaded.push_back(
          {int(h), int(drawn.size()) - 1, {backend, clip_shape(tool.clip_length, tool.parallel_gap).data()}});
      if (clips.count(tool.clip_length) == 0)
        clips.emplace(tool.clip_length, OwnedMesh(backend, clip_shape(tool.clip_length, 0).data()));
    }
  }
  scope = made(scope_parts(model.scope.shaft_radius), Detail(levels_of(model, "endoscope")), backend);
}

/// How far the jaws look open: no farther than a sleeve lets them in which they still are.
double SceneView::Parts::drawn_aperture(const sim::State& state, std::size_t hand) const {
  const interactions::ToolState& tool = state.tools[hand];
  const interactions::ToolModel& of = model.tool(state, hand);
  const interactions::ToolShape shape = shape_of(of, tool.pose(), tool.aperture);
  const double beyond = sleeve_end[hand] - dot(shape.pivot - model.hands[hand].port, shape.frame.axis());
  return std::min(tool.aperture, aperture_in_sleeve(of, beyond, sleeve_radius[hand]));
}

interactions::ToolShape SceneView::Parts::shape_in_trocar(const sim::State& state, std::size_t hand) const {
  return shape_of(model.tool(state, hand), state.tools[hand].pose(), drawn_aperture(state, hand));
}

void SceneView::Parts::update(const sim::State& state) {
  in_jaws.clear();
  std::vector<collision::Capsule> rods;  // of instruments that hold nothing: what is held is pressed by its jaws
  for (std::size_t h = 0; h < model.hands.size(); ++h) {
    const interactions::ToolState& tool = state.tools[h];
    const interactions::ToolShape shape = shape_of(model.tool(state, h), tool.pose(), tool.aperture);
    for (std::int32_t k = 0; k < tool.holds; ++k) in_jaws.push_back(tool.hold[k].body);
    if (tool.holds == 0) rods.insert(rods.end(), std::begin(shape.part), std::end(shape.part));
  }
  for (std::size_t i = 0; i < organs.size(); ++i)
    organs[i].update(state.solids[i], state.parted[i], rods, burns[i].update(state) ? &burns[i] : nullptr);
  for (std::size_t i = 0; i < cuttables.size(); ++i) {
    cuttables[i].burn(state, cuttable_burns[i]);
    cuttables[i].update(state.cuttables[i], rods);
  }
  for (std::size_t i = 0; i < fat.size(); ++i) fat[i].update(organs[std::size_t(fat_on[i])]);
  for (Drape& d : drapes) d.update(organs);
  adhesions->update(organs);
  for (TubeDrawing& t : tubes) t.update(state);
  for (TubeJoint& j : joints) j.joint.update(tubes[j.tube], j.organ < 0 ? nullptr : &organs[std::size_t(j.organ)]);
  for (Ridge& r : ridges) r.update(state);
  for (SheetDrawing& s : sheets) s.update(state);
  for (MembraneDrawing& m : membranes) m.update(state);
  for (PouchDrawing& p : pouches) p.update(state);
  for (DrawnVessels& v : vessels) v.drawing.update(state);
  for (std::size_t h = 0; h < port_sites.size(); ++h)
    port_sites[h].update(kinematics::forward(model.hands[h].port, state.tools[h].pose()).axis());
  for (LoadedClip& l : loaded) {
    if (state.tools[std::size_t(l.hand)].instrument != l.instrument) continue;
    const interactions::ToolModel& tool = model.tool(state, std::size_t(l.hand));
    const double open = tool.parallel_gap * drawn_aperture(state, std::size_t(l.hand));
    const MeshBuffer shape = clip_shape(tool.clip_length, std::max(0.0, open - 2 * kClipHalfGap));
    l.mesh.move(shape.positions, {});
  }
}

DrawItem& SceneView::Parts::list(DrawItem item, Detail& detail, std::span<const Vec3f> points, Frame& frame,
                                 bool whole) const {
  item.level = detail.level_at(eye->distance(points, item.transform), eye->index);
  item.detail = detail.surface(item.level);
  if (whole) item.level = 0;
  frame.items.push_back(item);
  return frame.items.back();
}

bool SceneView::Parts::held(std::size_t body) const {
  return std::find(in_jaws.begin(), in_jaws.end(), std::int32_t(body)) != in_jaws.end();
}

DrawItem& SceneView::Parts::list_rigid(const RigidMesh& mesh, DrawItem item, Detail& detail, Frame& frame) const {
  item.mesh = mesh.mesh.handle();
  return list(item, detail, mesh.points, frame);
}

/// Inside the body.
void SceneView::Parts::list_surroundings(Frame& frame) {
  const DrawItem peritoneum = item({}, look("peritoneum"), first.cavity);
  list_rigid(cavity, peritoneum, details.cavity, frame);
  for (std::size_t i = 0; i < margins.size(); ++i) list_rigid(margins[i], peritoneum, details.margins[i], frame);
  if (loops.handle().id) frame.items.push_back(item(loops.handle(), look("small_bowel"), first.cavity));
}

void SceneView::Parts::list_tissues(bool with_walls, Frame& frame) {
  for (std::size_t i = 0; with_walls && i < walls.size(); ++i)
    list(item(walls[i].handle(), look(model.walls[i].look), first.wall + i), details.walls[i], model.walls[i].skin.rest,
         frame);
  for (std::size_t i = 0; with_walls && i < aprons.size(); ++i)
    frame.items.push_back(item(aprons[i].handle(), look("omentum"), first.wall + apron_on[i]));
  for (std::size_t i = 0; i < organs.size(); ++i)
    list(item(organs[i].mesh(), look(model.solids[i].look), first.organ + i), details.organs[i], organs[i].positions(),
         frame, burns[i].any() || organs[i].dented() || held(interactions::kSolidBase + i));
  for (std::size_t i = 0; i < cuttables.size(); ++i) {
    DrawItem& drawn = list(item(cuttables[i].mesh(), look(model.cuttables[i].look), first.organ + organs.size() + i),
                           details.cuttables[i], cuttables[i].positions(), frame);
    drawn.material.two_sided = cuttables[i].cut();  // what is cut off may lie inside out
  }
  for (std::size_t i = 0; i < drapes.size(); ++i) {
    frame.items.push_back(item(drapes[i].mesh(), *drape_look[i], first.cavity));
    frame.items.back().material.two_sided = true;
  }
  for (std::size_t i = 0; i < fat.size(); ++i)
    if (fat[i].mesh().id)
      list(item(fat[i].mesh(), look("fat"), first.organ + std::size_t(fat_on[i])), details.fat[i],
           fat[i].buffer().positions, frame);
  for (std::size_t i = 0; i < tubes.size(); ++i) {
    const sim::StrandModel& strand = model.strands[i];
    DrawItem& tube = list(item(tubes[i].mesh(), look(strand.look), first.tube + i), details.tubes[i],
                          tubes[i].buffer().positions, frame, tubes[i].burnt() || held(i));
    if (strand.start.kind == sim::StrandEndModel::hosted && !strand.fimbriated)
      tube.material.tint = look(model.organ_look(strand.start.organ)).material.colour;
  }
  for (const TubeJoint& j : joints) {
    if (j.organ < 0 && !with_walls) continue;
    const Look& onto = j.organ < 0 ? look("peritoneum") : look(model.solids[std::size_t(j.organ)].look);
    frame.items.push_back(item(j.joint.mesh(), onto, first.tube + j.tube));
    if (j.organ >= 0) frame.items.back().material.tint = look(model.strands[j.tube].look).material.colour;
  }
  for (std::size_t i = 0; with_walls && i < ridges.size(); ++i)
    frame.items.push_back(item(ridges[i].mesh(), look("peritoneum"), first.tube + ridge_of[i]));
  for (std::size_t i = 0; i < vessels.size(); ++i)
    list(item(vessels[i].drawing.mesh(), *vessel_look[vessels[i].look], first.vessel + vessels[i].look),
         details.vessels[i], vessels[i].drawing.buffer().positions, frame);
  if (with_walls && adhesions->mesh().id)
    frame.items.push_back(item(adhesions->mesh(), look("adhesion"), first.cavity));
  for (std::size_t i = 0; i < sheets.size(); ++i)
    list(item(sheets[i].mesh(), look(model.sheets[i].look), first.fold + i), details.sheets[i],
         sheets[i].buffer().positions, frame);
  for (std::size_t i = 0; i < membranes.size(); ++i)
    list(item(membranes[i].mesh(), look(model.membranes[membrane_of[i]].look), first.membrane + membrane_of[i]),
         details.membranes[i], membranes[i].buffer().positions, frame,
         membranes[i].burnt() || held(interactions::kMembraneBase + membrane_of[i]));
  for (std::size_t i = 0; i < pouches.size(); ++i)
    list(item(pouches[i].mesh(), look(model.membranes[pouch_of[i]].look), first.membrane + pouch_of[i]),
         details.pouches[i], pouches[i].buffer().positions, frame,
         pouches[i].burnt() || held(interactions::kMembraneBase + pouch_of[i]));
}

void SceneView::Parts::list_port_sites(Frame& frame) const {
  for (const PortSite& site : port_sites)
    if (site.mesh().id) frame.items.push_back(item(site.mesh(), look(site.look()), first.cavity));
}

void SceneView::Parts::list_clips(const sim::State& state, Frame& frame) const {
  for (int i = 0; i < state.clip_count; ++i) {
    const interactions::Clip& c = state.clips[std::size_t(i)];
    if (c.dropped() || c.strand >= int(model.strands.size()) || c.vessel > int(model.vessels.list.size())) continue;
    if (clips.empty()) continue;
    const auto known = clips.find(c.length), mesh = known == clips.end() ? clips.begin() : known;
    const ClipPress at = press_of(c, model, state);
    const Mat3f turn =
        Mat3f::from_columns(vec_cast<float>(at.open), vec_cast<float>(at.normal), vec_cast<float>(at.axis));
    DrawItem drawn = item(mesh->second.handle(), *titanium, first.clips);
    drawn.transform = to_world({turn, vec_cast<float>(at.centre + at.low * at.axis)});
    frame.items.push_back(drawn);
    // Its tips have gone through the fold beside the tube, which is whole in the simulation: they show through it.
    drawn.translucent = true;
    drawn.material.alpha = kClipThroughFold;
    frame.items.push_back(drawn);
  }
}

void SceneView::Parts::list_tools(const sim::State& state, const ViewOptions& options, Frame& frame) {
  for (std::size_t t = 0; t < tools.size(); ++t) {
    const interactions::ToolState& tool = state.tools[t];
    const interactions::ToolShape shape = shape_in_trocar(state, t);
    const float soil = soil_on(state, t), pressed = pressure_of(tool);
    const Placement axis = placement_of(InstrumentPart::Joint::body, shape);
    for (DrawnPart& part : sleeves[t]) {
      DrawItem drawn = item({}, *part.look, first.tool + t);
      drawn.transform = to_world({axis.rotation, vec_cast<float>(model.hands[t].port)});
      list_rigid(part.drawn, drawn, part.detail, frame);
    }
    for (DrawnPart& part : tools[t][std::size_t(tool.instrument)]) {
      DrawItem drawn = item({}, *part.look, first.tool + t);
      drawn.transform = to_world(placement_of(part.joint, shape));
      drawn.material.soil = soil;
      list_rigid(part.drawn, drawn, part.detail, frame);
    }
    const bool shades = style_of(options.styles, std::uint16_t(first.tool + t)) == PartStyle::shaded;
    for (int k = 0; k < interactions::kToolParts && shades; ++k) {  // a jaw is wider than it is thick
      const collision::Capsule& rod = shape.part[k];
      const double half =
          k == interactions::kShaft ? rod.radius : std::max(rod.radius, 0.4 * model.tool(state, t).jaw_width);
      frame.rods.push_back(
          {vec_cast<float>(rod.a), vec_cast<float>(rod.b), float(half), k == interactions::kShaft ? 0 : pressed});
    }
    for (const LoadedClip& l : loaded) {
      if (l.hand != int(t) || l.instrument != tool.instrument || tool.clips_left <= 0) continue;
      if (!tool.armed && tool.aperture < 0.5) continue;  // the one that was there has just been set
      Placement place = placement_of(InstrumentPart::Joint::body, shape);
      place.translation += float(clip_seat(model.tool(state, t))) * place.rotation.column(2);
      DrawItem drawn = item(l.mesh.handle(), *titanium, first.tool + t);
      drawn.transform = to_world(place);
      frame.items.push_back(drawn);
    }
  }
}

void SceneView::Parts::list_scope(Vec3d port, const kinematics::FulcrumPose& pose, Frame& frame) {
  const kinematics::TipFrame tip = kinematics::forward(port, pose);
  Placement place;
  const Vec3d x = tip.opening(), z = tip.axis();
  place.rotation = Mat3f::from_columns(vec_cast<float>(x), vec_cast<float>(cross(z, x)), vec_cast<float>(z));
  place.translation = vec_cast<float>(tip.tip);
  for (DrawnPart& part : scope) {
    DrawItem drawn = item({}, *part.look, first.scope);
    drawn.transform = to_world(place);
    list_rigid(part.drawn, drawn, part.detail, frame);
  }
}

std::uint16_t SceneView::Parts::part_of(BodyKind kind, std::size_t i) const {
  switch (kind) {
    case BodyKind::organ:
      return std::uint16_t(first.organ + i);
    case BodyKind::strand:
      return std::uint16_t(first.tube + i);
    case BodyKind::membrane:
      return std::uint16_t(first.membrane + i);
    case BodyKind::arteries:
      return first.vessel;
    case BodyKind::veins:
      return std::uint16_t(first.vessel + vessel_look.size() - 1);
    case BodyKind::tools:
      break;
  }
  return 0;
}

/// Walls as grey clay. Where neither surfaces nor springs show where tissue is, its ghost does.
void SceneView::Parts::list_analysis(const sim::State& state, const AnalysisOptions& options, bool with_walls,
                                     Frame& frame) {
  for (std::size_t i = 0; with_walls && i < walls.size(); ++i)
    frame.items.push_back(item(walls[i].handle(), look(model.walls[i].look), first.wall + i));
  const std::size_t ghosts = frame.items.size();
  if (!options.strain && !options.springs) list_tissues(false, frame);
  if (options.pressure)
    std::erase_if(frame.items, [&](const DrawItem& i) {
      return i.part >= first.vessel && i.part < first.vessel + vessel_look.size();
    });
  for (std::size_t i = 0; i < frame.items.size(); ++i) {
    frame.items[i].material = clay(frame.items[i].material);
    if (i >= ghosts) frame.items[i].translucent = false, frame.items[i].style = render::DrawStyle::transparent;
  }
  analysis.list(
      state, options, [this](BodyKind kind, std::size_t i) { return part_of(kind, i); }, frame);
}

namespace {

/// Seen from outside the walls are drawn where they turn their inner side to the eye: the cavity lies open.
void cut_open(const std::vector<OwnedMesh>& walls, Frame& frame) {
  for (DrawItem& drawn : frame.items)
    for (const OwnedMesh& wall : walls)
      if (drawn.mesh.id == wall.handle().id) drawn.material.two_sided = false;
}

}  // namespace

namespace {

/// A vessel that lies in a fold is as thick as the fold's ripples are high and would be half in, half out of it: it is
/// drawn a little nearer than it is, in the same place of the picture (shrunk towards the eye).
void lift_out_of_folds(const std::vector<DrawnVessels>& vessels, Frame& frame) {
  for (const DrawnVessels& v : vessels) {
    if (!v.in_a_fold) continue;
    Vec3f middle{};
    const std::vector<Vec3f>& points = v.drawing.buffer().positions;
    for (const Vec3f& p : points) middle += p / float(points.size());
    const Vec3f eye = frame.camera.position;
    const float size = 1 - kVesselBefore / std::max(length(middle - eye), 0.03f);
    const Mat3f scale = Mat3f::from_columns({size, 0, 0}, {0, size, 0}, {0, 0, size});
    for (DrawItem& drawn : frame.items)
      if (drawn.mesh.id == v.drawing.mesh().id) drawn.transform = render::placement(scale, (1 - size) * eye);
  }
}

void apply(const std::vector<PartStyle>& styles, Frame& frame) {
  if (styles.empty()) return;
  std::erase_if(frame.items, [&](const DrawItem& i) { return style_of(styles, i.part) == PartStyle::hidden; });
  for (DrawItem& i : frame.items) {
    const PartStyle style = style_of(styles, i.part);
    if (style == PartStyle::transparent) i.style = render::DrawStyle::transparent;
    if (style == PartStyle::wireframe) i.style = render::DrawStyle::wireframe;
  }
}

}  // namespace

SceneView::SceneView(const sim::Model& model, render::Backend& backend)
    : m_parts(std::make_unique<Parts>(model, backend)) {
  if (model.wet.there) m_parts->wet.emplace(model);
}
SceneView::~SceneView() = default;

const std::vector<ScenePart>& SceneView::parts() const { return m_parts->parts; }

Frame SceneView::frame(const sim::State& state, const ViewOptions& options) {
  Parts& p = *m_parts;
  p.update(state);
  Frame frame;
  frame.tick = state.tick;
  frame.quality = options.quality;
  frame.eye = options.eye_index;
  frame.metering = options.metering;
  const bool inside = options.camera != ViewOptions::Camera::outside;
  if (inside) {
    const kinematics::ScopeFrame scope = sim::scope_of(p.model, state);
    frame.camera = scope_camera(scope, p.model.scope.field_of_view);
    kinematics::FulcrumPose shaft = pose_of(state.scope);
    shaft.roll = 0;
    const kinematics::TipFrame tip = kinematics::forward(p.model.scope.port, shaft);
    frame.look.notch_angle = float(notch_angle(scope, tip, double(state.scope.post)));
    if (options.camera == ViewOptions::Camera::inside) {
      const float cone = frame.camera.vertical_fov, near = frame.camera.near_plane, far = frame.camera.far_plane;
      frame.camera = outside_camera(options.eye, options.target, options.up, double(cone));
      frame.camera.near_plane = near;
      frame.camera.far_plane = far;
      frame.look.notch_angle = 0;
    }
  } else {
    frame.camera = outside_camera(options.eye, options.target, options.up, options.outside_fov);
    frame.light = room_light();
    frame.look = room_look();
    frame.background = {0.09f, 0.10f, 0.11f};
  }
  p.eye.emplace(frame.camera, options.picture_height, options.quality, options.eye_index);
  const bool measured = options.analysis.on();
  if (measured) {
    frame.light = light_for_analysis();
    frame.look = analysis_look();
    frame.background = {0.018f, 0.019f, 0.021f};
    p.list_analysis(state, options.analysis, inside || options.walls, frame);
  }
  if (inside && !measured) p.list_surroundings(frame);
  if (!measured) p.list_tissues(inside || options.walls, frame);
  if (!inside) cut_open(p.walls, frame);
  lift_out_of_folds(p.vessels, frame);
  p.list_clips(state, frame);
  if (options.instruments) p.list_tools(state, options, frame);
  if (options.instruments && inside && !measured) p.list_port_sites(frame);
  if (options.instruments && (!inside || options.second_scope))
    p.list_scope(p.model.scope.port, pose_of(state.scope), frame);
  if (options.instruments && !inside && options.second_scope)
    p.list_scope(options.second_scope->port, options.second_scope->pose, frame);
  apply(options.styles, frame);
  const auto shown = [&](std::uint16_t part) { return style_of(options.styles, part) != PartStyle::hidden; };
  if (measured) {  // colours say figures: nothing shades them, and no blood lies over them
    frame.rods.clear();
    return frame;
  }
  frame.liquid.part = p.first.liquid;
  if (p.wet && shown(p.first.liquid)) p.wet->list(state, frame);
  if (p.wet && shown(p.first.smoke)) {
    list_smoke(p.model.wet.model.smoke, state.fluids.smoke, frame);
    list_plumes(p.model, state, frame);
  }
  // Only the endoscope has a lens that fogs: other cameras look past it.
  if (p.wet && options.camera == ViewOptions::Camera::scope)
    p.lens.list(p.model.wet.model.smoke, state.fluids.smoke, frame);
  return frame;
}

}  // namespace trocar::view
