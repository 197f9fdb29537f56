#include <algorithm>
#include <cmath>

#include <trocar/sim/model/bodies.hpp>
#include <trocar/view/anatomy/bowel_loops.hpp>
#include <trocar/view/anatomy/omentum.hpp>
#include <trocar/view/bodies/cavity.hpp>
#include <trocar/view/scene/body_drawing.hpp>

namespace trocar::view {

using render::DrawItem;

namespace {

constexpr double kShadeCell = 0.001f, kShadeReach = 0.018f;  // [m] what shades what
constexpr float kMarginCell = 0.003f, kMarginReach = 0.07f;  // [m] what a liver's margin shades, from how far
constexpr double kMarginOpen = 0.94, kMarginDeepest = 0.12;  // where it does not; what is left right under it
constexpr float kBeforeWall = 0.004f;                        // [m]
// [m] in the order of what is translucent: before every fold that is in the picture
constexpr float kAfterFolds = 0.1f;
constexpr double kFatGlow = 0.4;  // of the light that is left in the omentum's creases: it goes through fat
constexpr int kLoopToWall = 3;    // adhesions of the small bowel

/// The look's unevenness, and a rise where each strand grows out.
Relief relief_of(int organ, const sim::Model& model) {
  Relief relief = look(model, model.organ_look(organ)).relief;
  for (std::size_t i = 0; i < model.strands.size(); ++i) {
    const sim::StrandAnatomy& strand = model.strands[i];
    const std::vector<Vec3d>& rest = model.strand_bodies[i].model.rest;
    const auto hangs = [&](const sim::StrandEndModel& end) {
      return end.kind == sim::StrandEndModel::hosted && end.organ() == organ;
    };
    if (hangs(strand.start)) relief.roots.push_back({rest.front(), strand.outer.front()});
    if (hangs(strand.end)) relief.roots.push_back({rest.back(), strand.outer.back()});
  }
  return relief;
}

/// Runs from an organ to a wall: a ridge covers where it goes into that.
bool is_ridge(const sim::StrandAnatomy& strand) {
  return strand.start.kind == sim::StrandEndModel::hosted && strand.end.kind == sim::StrandEndModel::fixed;
}

std::vector<Paint> shaded(const render::OpennessBaker& baker, std::span<const Vec3f> points,
                          std::span<const Vec3f> normals) {
  std::vector<Paint> paint(points.size());
  baker.bake(points, normals, paint);
  return paint;
}

}  // namespace

BodyDrawing::BodyDrawing(const sim::Model& model, render::Backend& backend)
    : m_model(&model), m_wall_look(&wall_look(model)), m_lining(lining(m_wall_look->material, model)) {
  const WallSurface walls(model);
  make_tubes(walls);
  make_cuttables(backend);
  m_bowel = bowel_loops(model, walls);
  for (int i = 0; i < model.organs(); ++i)
    if (look(model, model.organ_look(i)).has(Look::Generator::liver_dome))
      m_livers.emplace_back(model, i, liver_shape(i), walls, backend);
  make_aprons(walls);
  make_portas(backend);
  const render::OpennessBaker baker = shading();
  for (CuttableDrawing& c : m_cuttables) c.shade(baker);
  for (LiverDome& l : m_livers) l.shade(baker);
  make_organs(baker, backend);
  for (Porta& p : m_portas) p.settle(m_organs[p.solid()], baker);
  for (std::size_t s = 0; s < m_organs.size(); ++s)
    if (RawBed::lies_on(model, s)) m_beds.emplace_back(model, s, m_organs[s], backend);
  make_on_organs(walls, backend);
  for (const sim::WallModel& w : model.walls) make_wall(w, baker, backend);
  shade_aprons();
  for (std::size_t i = 0; i < m_apron_shapes.size(); ++i)
    m_aprons.push_back(fixed(m_apron_shapes[i], model.walls[m_apron_on[i]].name, backend));
  for (const MeshBuffer& apron : m_far_apron_shapes)
    if (apron.size() > 0) m_far_aprons.push_back(fixed(apron, "cavity", backend));
  make_surroundings(walls, baker, backend);
  for (TubeDrawing& t : m_tubes) t.create(shaded(baker, t.drawn().positions, t.drawn().normals), backend);
  make_joints(walls, backend);
  for (int i = 0; i < int(model.drawn_folds.size()); ++i) {
    m_details.sheets.emplace_back(levels_of(model, model.drawn_folds[std::size_t(i)].name));
    m_sheets.emplace_back(model, i, backend, m_details.sheets.back(), &walls);
  }
  make_vessels(backend);
  make_membranes(backend);
  for (int i = 0; i < int(model.marks.size()); ++i) m_marks.emplace_back(model, i, backend);
}

/// As fine as the scene says for that part.
BodyDrawing::Fixed BodyDrawing::fixed(const MeshBuffer& shape, const std::string& part,
                                      render::Backend& backend) const {
  const Detail detail(levels_of(*m_model, part));
  return {rigid(shape, detail, backend), detail};
}

LiverShape BodyDrawing::liver_shape(int organ) const {
  return sim::visit_organ(*m_model, std::size_t(organ),
                          sim::Overloaded{[&](sim::SolidRef r) {
                                            const tissue::Skin& body = model_of(*m_model, r).fine;
                                            return LiverShape{body.rest, flat_indices(body)};
                                          },
                                          [&](sim::CuttableRef r) {
                                            const CuttableDrawing& body = m_cuttables[r.index];
                                            return LiverShape{body.positions(), body.indices()};
                                          }});
}

void BodyDrawing::make_tubes(const WallSurface& walls) {
  for (int i = 0; i < int(m_model->strands.size()); ++i) {
    m_details.tubes.emplace_back(levels_of(*m_model, m_model->strands[std::size_t(i)].name));
    m_tubes.emplace_back(*m_model, i, m_details.tubes.back(), &walls);
  }
}

void BodyDrawing::make_cuttables(render::Backend& backend) {
  sim::visit_cuttables(*m_model, [&](auto r) {
    const sim::CuttableOrgan& organ = model_of(*m_model, r);
    m_cuttables.emplace_back(organ, relief_of(int(r.organ()), *m_model), backend, m_model->gravity);
    m_details.cuttables.emplace_back(levels_of(*m_model, organ.name));
    m_cuttable_burns.emplace_back(*m_model, r.id());
  });
}

/// Everything shades everything else, as drawn.
render::OpennessBaker BodyDrawing::shading() const {
  std::vector<std::vector<std::uint32_t>> indices;
  for (const sim::SolidModel& s : m_model->solids) indices.push_back(flat_indices(s.fine));
  for (const sim::WallModel& w : m_model->walls) indices.push_back(flat_indices(w.skin));
  std::vector<render::Occluder> occluders;
  for (const sim::SolidModel& s : m_model->solids) occluders.push_back({s.fine.rest, indices[occluders.size()]});
  for (const sim::WallModel& w : m_model->walls) occluders.push_back({w.skin.rest, indices[occluders.size()]});
  for (const CuttableDrawing& c : m_cuttables) occluders.push_back({c.positions(), c.indices()});
  for (const TubeDrawing& t : m_tubes) occluders.push_back({t.drawn().positions, t.drawn().indices});
  for (const MeshBuffer* gut : {&m_bowel.small, &m_bowel.large, &m_bowel.omentum})
    occluders.push_back({gut->positions, gut->indices});
  for (const std::vector<MeshBuffer>* shapes : {&m_apron_shapes, &m_far_apron_shapes})
    for (const MeshBuffer& a : *shapes) occluders.push_back({a.positions, a.indices});
  for (const LiverDome& l : m_livers) occluders.push_back({l.buffer().positions, l.buffer().indices});
  for (const Porta& p : m_portas) occluders.push_back({p.buffer().positions, p.buffer().indices});
  return render::OpennessBaker(occluders, kShadeCell, kShadeReach);
}

void BodyDrawing::make_organs(const render::OpennessBaker& baker, render::Backend& backend) {
  sim::visit_solids(*m_model, [&](auto r) {
    const sim::SolidModel& s = model_of(*m_model, r);
    m_burns.emplace_back(*m_model, r.id(), below_skin(s.fine));
    m_blanching.emplace_back(r.organ(), s.fine);
    m_details.organs.emplace_back(levels_of(*m_model, s.name));
    m_organs.emplace_back(s, relief_of(int(r.organ()), *m_model), shaded(baker, s.fine.rest, s.fine.rest_normal),
                          backend, m_details.organs.back());
  });
}

void BodyDrawing::make_on_organs(const WallSurface& walls, render::Backend& backend) {
  for (int i = 0; i < int(m_organs.size()); ++i) {
    const sim::SolidModel& solid = m_model->solids[std::size_t(i)];
    const int count = look(*m_model, solid.look).count(Look::Generator::fat_tags);
    if (count == 0) continue;
    m_details.fat.emplace_back(levels_of(*m_model, solid.name));
    m_fat.emplace_back(m_organs[std::size_t(i)], solid, count, m_model->gravity, backend, m_details.fat.back());
    m_fat_on.push_back(i);
  }
  for (int i = 0; i < int(m_organs.size()); ++i) {
    const Look& covered = look(*m_model, m_model->solids[std::size_t(i)].look);
    if (!covered.has(Look::Generator::drape)) continue;
    m_details.drapes.emplace_back(levels_of(*m_model, "cavity"));
    m_drapes.emplace_back(*m_model, i, m_organs, backend, m_details.drapes.back());
    m_drape_look.push_back(&covered);
  }
  m_details.adhesions = Detail(levels_of(*m_model, "cavity"));
  const Adhesions::Still still[] = {{&m_bowel.small, kLoopToWall}};
  m_adhesions.emplace(m_organs, *m_model, walls, still, backend, m_details.adhesions);
}

void BodyDrawing::make_wall(const sim::WallModel& wall, const render::OpennessBaker& baker, render::Backend& backend) {
  const tissue::Skin& skin = wall.skin;
  std::vector<Paint> paint = shaded(baker, skin.rest, skin.rest_normal);
  for (const LiverDome& l : m_livers) l.shade_behind(skin.rest, skin.rest_normal, paint);
  for (std::size_t v = 0; v < paint.size(); ++v) paint[v].tint = to_byte(fat_below(vec_cast<double>(skin.rest[v])));
  const std::vector<std::uint32_t> triangles = flat_indices(skin);
  m_details.walls.emplace_back(levels_of(*m_model, wall.name));
  const auto coarser = coarser_lists(skin.rest, triangles, paint, m_details.walls.back(), kRigid);
  m_walls.emplace_back(backend, render::MeshData{.positions = skin.rest,
                                                 .normals = skin.rest_normal,
                                                 .rest = {},
                                                 .paint = paint,
                                                 .indices = triangles,
                                                 .coarser = coarser});
}

/// A wall that asks for it has one on every organ that strands of its go into.
void BodyDrawing::make_portas(render::Backend& backend) {
  for (std::size_t w = 0; w < m_model->walls.size(); ++w) {
    if (!look(*m_model, m_model->walls[w].look).has(Look::Generator::porta)) continue;
    for (std::size_t s = 0; s < m_model->solids.size(); ++s)
      if (const std::vector<PortaEntry> entries = porta_entries(*m_model, w, s); !entries.empty())
        m_portas.emplace_back(*m_model, w, s, entries, backend);
  }
}

void BodyDrawing::make_aprons(const WallSurface& walls) {
  for (std::size_t i = 0; i < m_model->walls.size(); ++i) {
    const sim::WallModel& wall = m_model->walls[i];
    if (!look(*m_model, wall.look).has(Look::Generator::omentum)) continue;
    MeshBuffer apron = omentum_on(wall.skin, m_model->gravity);
    if (apron.size() == 0) continue;
    m_apron_shapes.push_back(std::move(apron));
    m_apron_on.push_back(i);
    m_far_apron_shapes.push_back(omentum_beyond(wall.skin, m_model->gravity, walls.cavity()));
    if (m_cuttables.empty()) continue;
    m_stains.add_ground(m_apron_shapes.back());
    m_stains.add_ground(m_far_apron_shapes.back());
  }
}

/// A liver's margin lies on the omentum, or close over it: dark along it.
void BodyDrawing::shade_aprons() {
  std::vector<render::Occluder> above;
  for (const CuttableDrawing& c : m_cuttables) above.push_back({c.positions(), c.indices()});
  for (const LiverDome& l : m_livers) above.push_back({l.buffer().positions, l.buffer().indices});
  if (m_livers.empty()) return;
  const render::OpennessBaker baker(above, kMarginCell, kMarginReach);
  for (std::vector<MeshBuffer>* shapes : {&m_apron_shapes, &m_far_apron_shapes})
    for (MeshBuffer& apron : *shapes) {
      std::vector<Paint> below(apron.size());
      baker.bake(apron.positions, apron.normals, below);
      for (std::size_t i = 0; i < below.size(); ++i) {
        const double open = std::min(1.0, below[i].openness / (255 * kMarginOpen));
        const double lit = std::max(kMarginDeepest, std::pow(open, 5));
        apron.paint[i].openness = std::uint8_t(apron.paint[i].openness * lit);
        apron.paint[i].tint = std::max(apron.paint[i].tint, to_byte(1 - lit));  // and redder
      }
    }
}

void BodyDrawing::make_surroundings(const WallSurface& walls, const render::OpennessBaker& baker,
                                    render::Backend& backend) {
  m_details.cavity = Detail(levels_of(*m_model, "cavity"));
  m_cavity_shape = walls.cavity();
  std::vector<Vec3f> before = m_cavity_shape.positions;  // what lies below a wall is shaded as the wall before it
  for (std::size_t i = 0; i < before.size(); ++i) before[i] += kBeforeWall * m_cavity_shape.normals[i];
  baker.bake(before, m_cavity_shape.normals, m_cavity_shape.paint);
  for (const LiverDome& l : m_livers) l.shade_behind(before, m_cavity_shape.normals, m_cavity_shape.paint);
  m_cavity = rigid(m_cavity_shape, m_details.cavity, backend);
  for (MeshBuffer* gut : {&m_bowel.small, &m_bowel.large}) {
    if (gut->size() == 0) continue;
    gut->paint = shaded(baker, gut->positions, gut->normals);
    (gut == &m_bowel.small ? m_loops : m_large_loop) = fixed(*gut, "cavity", backend);
  }
  if (MeshBuffer& lobe = m_bowel.omentum; lobe.size() > 0) {
    const std::vector<Paint> shade = shaded(baker, lobe.positions, lobe.normals);
    for (std::size_t i = 0; i < shade.size(); ++i)
      lobe.paint[i].openness =
          std::uint8_t(lobe.paint[i].openness * (kFatGlow + (1 - kFatGlow) * shade[i].openness / 255));
    m_lobe = fixed(lobe, "cavity", backend);
  }
}

void BodyDrawing::make_joints(const WallSurface& walls, render::Backend& backend) {
  for (std::size_t i = 0; i < m_tubes.size(); ++i)
    for (const bool at_start : {true, false}) {
      if (m_tubes[i].neck(at_start).far <= 0) continue;
      const sim::StrandEndModel& end = at_start ? m_model->strands[i].start : m_model->strands[i].end;
      if (end.kind != sim::StrandEndModel::hosted) {
        const bool ridge = !at_start && !m_model->walls.empty() && is_ridge(m_model->strands[i]);
        if (ridge && !Ridge::meets_head_on(*m_model, m_tubes[i], int(i), walls)) continue;
        m_details.joints.emplace_back(levels_of(*m_model, m_model->strands[i].name));
        m_joints.push_back({i, -1, Joint(m_tubes[i], at_start, walls, backend, m_details.joints.back())});
        continue;
      }
      const auto organ = std::size_t(end.organ());
      m_details.joints.emplace_back(levels_of(*m_model, m_model->solids[organ].name));
      m_joints.push_back({i, end.organ(),
                          Joint(m_tubes[i], at_start, m_organs[organ], m_model->solids[organ].fine, backend,
                                m_details.joints.back())});
    }
  for (std::size_t i = 0; i < m_tubes.size() && !m_model->walls.empty(); ++i) {
    const sim::StrandAnatomy& strand = m_model->strands[i];
    if (!is_ridge(strand) || Ridge::meets_head_on(*m_model, m_tubes[i], int(i), walls)) continue;
    m_details.ridges.emplace_back(levels_of(*m_model, strand.name));
    m_ridges.emplace_back(*m_model, m_tubes[i], int(i), walls, backend, m_details.ridges.back());
    m_ridge_of.push_back(i);
  }
}

void BodyDrawing::make_vessels(render::Backend& backend) {
  using Lie = VesselDrawing::Lie;
  for (const bool veins : {false, true}) {
    const auto some = [&](bool fold) {
      return std::any_of(m_model->vessels.list.begin(), m_model->vessels.list.end(), [&](const sim::Vessel& v) {
        return v.vein == veins && in_a_fold(v.path) == fold && is_in_sight(v.path);
      });
    };
    if (!some(false) && !some(true)) continue;
    const Detail detail(levels_of(*m_model, veins ? "veins" : "arteries"));
    m_vessel_look.push_back(&look(*m_model, veins ? "vein" : "artery"));
    for (const bool fold : {false, true}) {
      if (!some(fold)) continue;
      m_details.vessels.push_back(detail);
      m_vessels.push_back({VesselDrawing(*m_model, veins, backend, detail, fold ? Lie::in_a_fold : Lie::elsewhere),
                           fold, m_vessel_look.size() - 1});
    }
  }
}

void BodyDrawing::make_membranes(render::Backend& backend) {
  for (std::size_t i = 0; i < m_model->membranes.size(); ++i) {
    const Detail detail(levels_of(*m_model, m_model->membranes[i].name));
    if (m_model->membranes[i].sheet.closed()) {
      m_pouches.emplace_back(*m_model, int(i), backend, detail);
      m_details.pouches.push_back(detail);
      m_pouch_of.push_back(i);
    } else {
      m_membranes.emplace_back(*m_model, int(i), backend, detail);
      m_details.membranes.push_back(detail);
      m_membrane_of.push_back(i);
    }
  }
  for (std::size_t i = 0; i < m_model->bonds.size(); ++i) {
    if (!m_model->bonds[i].of_membrane()) continue;  // fat draws its own
    m_bonds.emplace_back(*m_model, i, backend);
    m_veils.emplace_back(*m_model, i, backend);
  }
  for (std::size_t i = 0; i < m_model->bonds.size(); ++i)
    if (m_model->bonds[i].breaches) m_breaches.emplace_back(*m_model, i, backend);
}

void BodyDrawing::list_ooze(render::Liquid& liquid) const {
  for (const CuttableDrawing& c : m_cuttables) {
    if (!c.cut()) continue;
    c.list_ooze(liquid);
    m_stains.list(c.drips(), liquid);
  }
}

std::vector<std::string> BodyDrawing::vessel_kinds() const {
  std::vector<std::string> names;
  for (const Look* l : m_vessel_look) names.emplace_back(l == &look(*m_model, "vein") ? "veins" : "arteries");
  return names;
}

void BodyDrawing::update(const sim::State& state) {
  m_in_jaws.clear();
  std::vector<collision::Capsule> rods;  // of instruments that hold nothing: what is held is pressed by its jaws
  for (std::size_t h = 0; h < m_model->hands.size(); ++h) {
    const interactions::ToolState& tool = state.tools[h];
    const interactions::ToolShape shape = sim::shape_of(*m_model, state, h);
    for (std::int32_t k = 0; k < tool.holds; ++k) m_in_jaws.push_back(tool.hold[k].at.body);
    for (int part = 0; tool.holds == 0 && part < end_of(shape); part = interactions::next(part))
      rods.push_back(shape.rod(part));
  }
  for (std::size_t i = 0; i < m_organs.size(); ++i)
    m_organs[i].update(state.solids[i], state.parted[i], rods, m_burns[i].update(state) ? &m_burns[i] : nullptr,
                       m_blanching[i].update(state) ? &m_blanching[i] : nullptr);
  for (std::size_t i = 0; i < m_cuttables.size(); ++i) {
    m_cuttables[i].burn(state, m_cuttable_burns[i]);
    m_cuttables[i].update(state.cuttables[i], rods);
  }
  for (std::size_t i = 0; i < m_fat.size(); ++i) m_fat[i].update(m_organs[std::size_t(m_fat_on[i])]);
  for (LiverDome& l : m_livers) l.update(state);
  for (Porta& p : m_portas) p.update(m_organs[p.solid()]);
  for (RawBed& b : m_beds) b.update(state, m_organs[b.solid()]);
  for (Drape& d : m_drapes) d.update(m_organs);
  m_adhesions->update(m_organs);
  for (TubeDrawing& t : m_tubes) t.update(state);
  for (TubeJoint& j : m_joints)
    j.joint.update(m_tubes[j.tube], j.organ < 0 ? nullptr : &m_organs[std::size_t(j.organ)]);
  for (Ridge& r : m_ridges) r.update(state);
  for (SheetDrawing& s : m_sheets) s.update(state);
  for (MembraneDrawing& m : m_membranes) m.update(state);
  for (PouchDrawing& p : m_pouches) p.update(state);
  for (BondDrawing& b : m_bonds) b.update(state);
  for (BondVeils& v : m_veils) v.update(state);
  for (BreachDrawing& b : m_breaches) b.update(state);
  for (DrawnVessels& v : m_vessels) v.drawing.update(state);
  for (MarkDrawing& m : m_marks) m.update(state, m_tubes);
}

bool BodyDrawing::held(BodyId body) const {
  return std::find(m_in_jaws.begin(), m_in_jaws.end(), body) != m_in_jaws.end();
}

bool BodyDrawing::is_wall(render::MeshHandle mesh) const {
  return std::any_of(m_walls.begin(), m_walls.end(), [&](const OwnedMesh& w) { return w.handle().id == mesh.id; });
}

Vec3f BodyDrawing::returned() const {
  const Vec3f pink = render::Light{}.bounce_colour;
  if (is_alive(*m_wall_look)) return pink;
  const Vec3f share{0.2126f, 0.7152f, 0.0722f};  // CIE luminance: as much light as tissue returns, our choice
  const Vec3f own = m_wall_look->material.colour;
  return (dot(pink, share) / std::max(dot(own, share), 1e-3f)) * own;
}

/// Vessels of walls, and of what lies on them, continue from mesh to mesh.
DrawItem BodyDrawing::as_lining(DrawItem item) const {
  if (!item.material.lining) return item;
  item.material.middle = m_lining.middle;
  item.material.fibre_axis = m_lining.fibre_axis;
  return item;
}

void BodyDrawing::list_surroundings(const FirstParts& first, const Listing& to) {
  to.add(m_cavity, as_lining(item({}, *m_wall_look, first.cavity)), m_details.cavity);
  for (Fixed& apron : m_far_aprons) to.add(apron.mesh, item({}, look(*m_model, "omentum"), first.cavity), apron.detail);
  if (m_loops) to.add(m_loops->mesh, item({}, look(*m_model, "small_bowel"), first.cavity), m_loops->detail);
  if (m_lobe) to.add(m_lobe->mesh, item({}, look(*m_model, "omentum_border"), first.cavity), m_lobe->detail);
  if (m_large_loop) to.add(m_large_loop->mesh, item({}, look(*m_model, "bowel"), first.cavity), m_large_loop->detail);
}

void BodyDrawing::list_walls(const FirstParts& first, const Listing& to) {
  for (std::size_t i = 0; i < m_walls.size(); ++i)
    to.add(as_lining(item(m_walls[i].handle(), look(*m_model, m_model->walls[i].look), first.wall + i)),
           m_details.walls[i], m_model->walls[i].skin.rest);
}

void BodyDrawing::list(bool with_walls, const FirstParts& first, const Listing& to) {
  if (with_walls) list_walls(first, to);
  for (std::size_t i = 0; with_walls && i < m_aprons.size(); ++i)
    to.add(m_aprons[i].mesh, item({}, look(*m_model, "omentum"), first.wall + m_apron_on[i]), m_aprons[i].detail);
  list_organs(with_walls, first, to);
  for (std::size_t i = 0; with_walls && i < m_livers.size(); ++i)  // without the wall that it lies on it would be a rag
    m_livers[i].list(first.of(BodyId::organ(std::size_t(m_livers[i].organ()))), to);
  for (Porta& p : m_portas) {
    if (!with_walls) break;  // without the ligament that it lies on it would be a rag
    const sim::WallModel& wall = m_model->walls[p.wall()];
    DrawItem porta = item(p.mesh(), look(*m_model, wall.look), first.wall + p.wall());
    porta.material.tint = look(*m_model, m_model->solids[p.solid()].look).material.colour;
    to.add(porta, p.detail(), p.buffer().positions);
  }
  list_tubes(with_walls, first, to);
  list_vessels(false, first, to);
  if (with_walls && m_adhesions->mesh().id)
    to.add(item(m_adhesions->mesh(), look(*m_model, "adhesion"), first.cavity), m_details.adhesions,
           m_adhesions->buffer().positions);
  list_folds(with_walls, first, to);
  list_vessels(true, first, to);
  for (std::size_t i = 0; i < m_marks.size(); ++i) m_marks[i].list(first.mark + i, to);
}

/// Those in folds come after these and let them shine through: they are seen within, soft and half veiled, whatever the
/// folds' ripples do.
void BodyDrawing::list_vessels(bool in_folds, const FirstParts& first, const Listing& to) {
  for (std::size_t i = 0; i < m_vessels.size(); ++i) {
    const DrawnVessels& v = m_vessels[i];
    if (v.in_a_fold != in_folds) continue;
    const Look& own = *m_vessel_look[v.look];
    DrawItem drawn = item(v.drawing.mesh(), own, first.vessel + v.look);
    if (in_folds) {
      const Look& veiled = look(*m_model, own.name + "_in_fold");
      drawn.material = veiled.material;
      drawn.translucent = true;
      drawn.nearer = kAfterFolds;
    }
    to.add(drawn, m_details.vessels[i], v.drawing.buffer().positions);
  }
}

void BodyDrawing::list_organs(bool with_walls, const FirstParts& first, const Listing& to) {
  // Before what it lies on, which then need not be shaded below it.
  for (const RawBed& b : m_beds)
    if (b.any()) to.add(item(b.mesh(), look(*m_model, "gallbladder_bed"), first.of(BodyId::organ(b.solid()))));
  for (std::size_t i = 0; i < m_organs.size(); ++i) {
    DrawItem organ = item(m_organs[i].mesh(), look(*m_model, m_model->solids[i].look), first.of(BodyId::organ(i)));
    if (m_blanching[i].any()) {
      organ.material.tint = pale_of(organ.material.colour);
      organ.material.soil = kVesselsLeft;
    }
    to.add(organ, m_details.organs[i], m_organs[i].positions(),
           m_burns[i].any() || m_blanching[i].any() || m_organs[i].dented() || held(BodyId::organ(i)));
  }
  sim::visit_cuttables(*m_model, [&](sim::CuttableRef organ) {
    CuttableDrawing& shape = m_cuttables[organ.index];
    DrawItem& drawn = to.add(item(shape.mesh(), look(*m_model, model_of(*m_model, organ).look), first.of(organ.id())),
                             m_details.cuttables[organ.index], shape.positions());
    drawn.material.two_sided = shape.cut();  // what is cut off may lie inside out
  });
  for (std::size_t i = 0; with_walls && i < m_drapes.size(); ++i) {  // the wall's peritoneum
    DrawItem drape = item(m_drapes[i].mesh(), *m_drape_look[i], first.cavity);
    drape.material.two_sided = true;
    drape.material.tint = look(*m_model, "peritoneum").material.colour;
    to.add(drape, m_details.drapes[i], m_drapes[i].buffer().positions);
  }
  for (std::size_t i = 0; i < m_fat.size(); ++i)
    if (m_fat[i].mesh().id)
      to.add(item(m_fat[i].mesh(), look(*m_model, "fat"), first.of(BodyId::organ(std::size_t(m_fat_on[i])))),
             m_details.fat[i], m_fat[i].buffer().positions);
}

void BodyDrawing::list_tubes(bool with_walls, const FirstParts& first, const Listing& to) {
  for (std::size_t i = 0; i < m_tubes.size(); ++i) {
    const sim::StrandAnatomy& strand = m_model->strands[i];
    DrawItem& tube =
        to.add(item(m_tubes[i].mesh(), look(*m_model, strand.look), first.of(BodyId::strand(i))), m_details.tubes[i],
               m_tubes[i].buffer().positions, m_tubes[i].burnt() || held(BodyId::strand(i)));
    if (strand.start.kind == sim::StrandEndModel::hosted && !strand.fimbriated)
      tube.material.tint = look(*m_model, m_model->organ_look(strand.start.organ())).material.colour;
  }
  for (std::size_t i = 0; i < m_joints.size(); ++i) {
    const TubeJoint& j = m_joints[i];
    if (j.organ < 0 && !with_walls) continue;
    const Look& onto = j.organ < 0 ? *m_wall_look : look(*m_model, m_model->solids[std::size_t(j.organ)].look);
    // Made of what its organ is made of: it is shown, hidden and seen through with that.
    const std::size_t part =
        j.organ < 0 ? first.of(BodyId::strand(j.tube)) : first.of(BodyId::organ(std::size_t(j.organ)));
    DrawItem joint = as_lining(item(j.joint.mesh(), onto, part));
    if (j.organ >= 0) joint.material.tint = look(*m_model, m_model->strands[j.tube].look).material.colour;
    to.add(joint, m_details.joints[i], j.joint.buffer().positions, j.organ >= 0 && m_burns[std::size_t(j.organ)].any());
  }
  for (std::size_t i = 0; with_walls && i < m_ridges.size(); ++i) {
    DrawItem ridge = as_lining(item(m_ridges[i].mesh(), *m_wall_look, first.of(BodyId::strand(m_ridge_of[i]))));
    ridge.material.tint = look(*m_model, m_model->strands[m_ridge_of[i]].look).material.colour;
    to.add(ridge, m_details.ridges[i], m_ridges[i].buffer().positions, m_tubes[m_ridge_of[i]].burnt());
  }
}

void BodyDrawing::list_folds(bool with_walls, const FirstParts& first, const Listing& to) {
  for (std::size_t i = 0; i < m_sheets.size(); ++i)
    if (with_walls || !m_sheets[i].has_hem())  // without the wall that it is lost on it would be a cloud
      to.add(item(m_sheets[i].mesh(), look(*m_model, m_model->drawn_folds[i].look), first.fold + i),
             m_details.sheets[i], m_sheets[i].buffer().positions);
  const auto look_of = [&](std::size_t membrane) -> const Look& {
    return look(*m_model, m_model->membranes[membrane].look);
  };
  for (std::size_t i = 0; i < m_membranes.size(); ++i)
    to.add(item(m_membranes[i].mesh(), look_of(m_membrane_of[i]), first.of(BodyId::membrane(m_membrane_of[i]))),
           m_details.membranes[i], m_membranes[i].buffer().positions,
           m_membranes[i].burnt() || held(BodyId::membrane(std::size_t(m_membrane_of[i]))));
  for (std::size_t i = 0; i < m_pouches.size(); ++i)
    to.add(item(m_pouches[i].mesh(), look_of(m_pouch_of[i]), first.of(BodyId::membrane(m_pouch_of[i]))),
           m_details.pouches[i], m_pouches[i].buffer().positions,
           m_pouches[i].burnt() || held(BodyId::membrane(std::size_t(m_pouch_of[i]))));
  for (const BondDrawing& b : m_bonds)
    to.add(item(b.mesh(), look(*m_model, "adhesion"), first.of(BodyId::membrane(b.membrane()))));
  for (const BondVeils& v : m_veils)
    if (v.any()) to.add(item(v.mesh(), look(*m_model, "areolar"), first.of(BodyId::membrane(v.membrane()))));
  for (const BreachDrawing& b : m_breaches)
    if (b.any()) to.add(item(b.mesh(), look(*m_model, "liver_raw"), first.of(BodyId::organ(std::size_t(b.organ())))));
}

}  // namespace trocar::view
