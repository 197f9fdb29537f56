#include <algorithm>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/contact/body_push.hpp>
#include <trocar/interactions/contact/nearest_skin.hpp>
#include <trocar/scene/compile/compile_contacts.hpp>
#include <trocar/sim/model/bodies.hpp>

namespace trocar::scene {
namespace {

constexpr double kReach = 0.045;     // [m] further apart than this in the drawn shape, two bodies are not tested
constexpr double kRoot = 0.008;      // [m] of a strand next to its host that takes no part in contact with it
constexpr int kSolidSamples = 160;   // skin vertices of an organ, about, that are tested against its neighbours
constexpr double kSlender = 16;      // interactions::slenderness: stouter organs are not tested against themselves
constexpr double kCrease = 4;        // cells along the skin that are one part of it
constexpr double kTogether = 0.008;  // [m] drawn nearer than this, rods and membranes are joined

/// Poses of all surfaces in the drawn shape.
struct Drawn {
  sim::State state;
  std::vector<tissue::SkinPose> pose;
  std::vector<interactions::Surface> surface;   ///< of organs, then of walls
  std::vector<interactions::Surface> membrane;  ///< of membranes

  explicit Drawn(const sim::Model& model) {
    for (const sim::SolidModel& s : model.solids) state.solids.push_back(tissue::rest_state(s.network));
    for (const sim::CuttableOrgan& c : model.cuttables) state.cuttables.push_back(tissue::rest_state(c.body));
    for (const sim::MembraneBody& m : model.membranes) state.membranes.push_back(tissue::rest_state(m.sheet));
    pose.reserve(size_t(model.surfaces()) + model.membranes.size());
    for (int i = 0; i < model.organs(); ++i) {
      const tissue::NodeView nodes = nodes_of(model, state, i);
      pose.push_back(tissue::make_pose(model.skin(i)));
      tissue::pose_skin(nodes, model.skin(i), pose.back());
      surface.push_back({&model.skin(i), &pose.back(), nodes});
    }
    for (const sim::WallModel& w : model.walls) {
      pose.push_back(w.pose);
      surface.push_back({&w.skin, &pose.back(), {}});
    }
    for (size_t i = 0; i < model.membranes.size(); ++i) {
      const sim::MembraneBody& m = model.membranes[i];
      const tissue::NodeView nodes = view_of(m.sheet.network, state.membranes[i].network);
      pose.push_back(tissue::make_pose(m.skin));
      tissue::pose_skin(nodes, m.skin, pose.back());
      membrane.push_back({&m.skin, &pose.back(), nodes});
    }
  }
  const interactions::Surface& skin_of_body(BodyId body) const {
    return body.is(BodyKind::organ) ? surface[body.index()] : membrane[body.index()];
  }
  Drawn(const Drawn&) = delete;  // it points into itself
};

/// Adds a sample with its start vertex and its overlap in the drawn shape. @param radius  of a rod; else 0
void add_sample(interactions::SurfacePair& pair, const interactions::Surface& surface, int sample, Vec3d p,
                double radius, std::vector<std::int32_t>& nearest) {
  const int vertex = interactions::nearest_vertex(surface, p);
  double distance = interactions::clearance_at(surface, vertex, p).distance;
  if (pair.strand >= 0) {
    const interactions::SkinPoint under = interactions::nearest_skin_point(surface, vertex, p);
    distance = dot(p - under.point, under.normal);
  }
  pair.sample.push_back(sample);
  pair.radius.push_back(float(radius));
  pair.overlap.push_back(float(std::max(0.0, radius - distance)));
  nearest.push_back(vertex);
}

bool rooted(const sim::StrandEndModel& end, int surface) {
  return end.kind == sim::StrandEndModel::hosted && end.organ() == surface;
}

void pair_strand(sim::Model& model, const Drawn& drawn, int strand, int surface) {
  const interactions::StrandBody& body = model.strand_bodies[size_t(strand)];
  const sim::StrandAnatomy& names = model.strands[size_t(strand)];
  const interactions::Surface& s = drawn.surface[size_t(surface)];
  interactions::SurfacePair pair;
  pair.strand = strand;
  pair.surface = surface;
  std::vector<std::int32_t> nearest;
  for (int n = 0; n < body.nodes(); ++n) {
    const double arc = body.arc[size_t(n)];
    if (body.model.prescribed[size_t(n)]) continue;
    if (rooted(names.start, surface) && arc < kRoot) continue;
    if (rooted(names.end, surface) && body.length() - arc < kRoot) continue;
    const Vec3d p = body.model.rest[size_t(n)];
    if (!s.pose->bounds.reaches(p, kReach)) continue;
    add_sample(pair, s, n, p, names.outer[size_t(n)], nearest);
  }
  if (pair.sample.empty()) return;
  model.surface_pairs.push_back(std::move(pair));
  model.nearest_at_start.insert(model.nearest_at_start.end(), nearest.begin(), nearest.end());
}

/// The skin vertices of an organ that are tested: about kSolidSamples of those on its surface.
std::vector<int> samples_of(const tissue::Skin& skin) {
  std::vector<int> outside, chosen;
  for (int v = 0; v < skin.size(); ++v)
    if (skin.at_surface(v)) outside.push_back(v);
  const size_t stride = std::max(size_t(1), outside.size() / size_t(kSolidSamples));
  for (size_t i = 0; i < outside.size(); i += stride) chosen.push_back(outside[i]);
  return chosen;
}

void pair_solid(sim::Model& model, const Drawn& drawn, int solid, int surface) {
  const interactions::Surface& samples = drawn.surface[size_t(solid)];
  const interactions::Surface& s = drawn.surface[size_t(surface)];
  if (!s.pose->bounds.near_box(samples.pose->bounds, float(kReach) * 0.5f)) return;
  interactions::SurfacePair pair;
  pair.solid = solid;
  pair.surface = surface;
  std::vector<std::int32_t> nearest;
  for (const int v : samples_of(*samples.skin)) {
    const Vec3d p = samples.position(v);
    if (!s.pose->bounds.reaches(p, kReach * 0.5)) continue;
    add_sample(pair, s, v, p, 0.0, nearest);
  }
  if (pair.sample.empty()) return;
  model.surface_pairs.push_back(std::move(pair));
  model.nearest_at_start.insert(model.nearest_at_start.end(), nearest.begin(), nearest.end());
}

/// Any piece of an organ that can be cut must land on something: all its nodes are tested against walls, those inside
/// it and those that cuts will double as soon as they are at its surface. Where they then are nobody knows yet.
void pair_cuttable(sim::Model& model, const Drawn& drawn, int organ, int wall) {
  const interactions::Surface& samples = drawn.surface[size_t(organ)];
  const interactions::Surface& s = drawn.surface[size_t(wall)];
  interactions::SurfacePair pair;
  pair.solid = organ;
  pair.surface = wall;
  std::vector<std::int32_t> nearest;
  for (int v = 0; v < samples.skin->size(); ++v) {
    const Vec3d p = samples.position(v);
    if (samples.skin->at_surface(v) && s.pose->bounds.reaches(p, kReach * 0.5)) {
      add_sample(pair, s, v, p, 0.0, nearest);
      continue;
    }
    pair.sample.push_back(v);
    pair.radius.push_back(0);
    pair.overlap.push_back(0);
    nearest.push_back(0);
  }
  model.surface_pairs.push_back(std::move(pair));
  model.nearest_at_start.insert(model.nearest_at_start.end(), nearest.begin(), nearest.end());
}

/// What a membrane hangs on, it touches there.
bool carries(const sim::MembraneBody& membrane, int organ) {
  for (const interactions::Attachment& hold : membrane.holds)
    if (hold.point.body == BodyId::organ(size_t(organ))) return true;
  return false;
}

/// Nodes that are not next to a base: a fold's last rows; of a pouch, all that a triangle joins with what is held.
std::vector<bool> away_from_base(const tissue::MembraneModel& sheet) {
  std::vector<bool> apart(size_t(sheet.nodes()), true);
  if (!sheet.closed()) {
    for (int n = 0; n < sheet.nodes(); ++n) apart[size_t(n)] = n / sheet.columns + 2 < sheet.rows;
    return apart;
  }
  for (const auto& t : sheet.triangles)
    for (int held : t)
      for (int n : t)
        if (sheet.network.fixed[size_t(held)] == tissue::kHeld) apart[size_t(n)] = false;
  return apart;
}

/// The inner nodes of a membrane against a surface; not next to a base that rides on that surface.
void pair_membrane(sim::Model& model, const Drawn& drawn, int membrane, int surface) {
  const sim::MembraneBody& m = model.membranes[size_t(membrane)];
  const interactions::Surface& s = drawn.surface[size_t(surface)];
  const bool rides = surface < model.organs() && carries(m, surface);
  interactions::SurfacePair pair;
  pair.membrane = membrane;
  pair.surface = surface;
  std::vector<std::int32_t> nearest;
  const std::vector<bool> apart = rides ? away_from_base(m.sheet) : std::vector<bool>(size_t(m.sheet.nodes()), true);
  for (int n = 0; n < m.sheet.nodes(); ++n) {
    if (m.sheet.network.fixed[size_t(n)] == tissue::kHeld || !apart[size_t(n)]) continue;
    const Vec3d p = m.sheet.network.rest[size_t(n)];
    if (!s.pose->bounds.reaches(p, kReach)) continue;
    add_sample(pair, s, n, p, 0.0, nearest);
  }
  if (pair.sample.empty()) return;
  model.surface_pairs.push_back(std::move(pair));
  model.nearest_at_start.insert(model.nearest_at_start.end(), nearest.begin(), nearest.end());
}

void pair_strands(sim::Model& model, int a, int b) {
  const interactions::StrandBody &first = model.strand_bodies[size_t(a)], &second = model.strand_bodies[size_t(b)];
  interactions::StrandPair pair;
  pair.a = a;
  pair.b = b;
  std::vector<std::int32_t> nearest;
  for (int i = 0; i + 1 < first.nodes(); ++i) {
    double least = 1e9, overlap = 0;
    std::int32_t at = 0;
    for (int j = 0; j + 1 < second.nodes(); ++j) {
      const Vec3d a0 = first.model.rest[size_t(i)], a1 = first.model.rest[size_t(i) + 1];
      const Vec3d b0 = second.model.rest[size_t(j)], b1 = second.model.rest[size_t(j) + 1];
      const auto p = geometry::closest_segments(a0, a1, b0, b1);
      const double distance = length(a0 + p.s * (a1 - a0) - (b0 + p.t * (b1 - b0)));
      if (distance >= least) continue;
      least = distance;
      at = j;
      overlap = std::max(0.0, first.model.radius[size_t(i)] + second.model.radius[size_t(j)] - distance);
    }
    pair.overlap.push_back(float(overlap));
    nearest.push_back(at);
  }
  model.strand_pairs.push_back(std::move(pair));
  model.nearest_at_start.insert(model.nearest_at_start.end(), nearest.begin(), nearest.end());
}

double cell_of(const sim::Model& model, int organ) {
  return visit_organ(model, size_t(organ), [&](auto ref) { return model_of(model, ref).cell; });
}

/// An organ against itself. No part is known to be near: samples have not looked yet.
void pair_self(sim::Model& model, const Drawn& drawn, int organ) {
  const interactions::Surface& surface = drawn.surface[size_t(organ)];
  if (interactions::slenderness(*surface.skin) < kSlender) return;
  model.self_pairs.push_back(
      make_self_pair(organ, surface, samples_of(*surface.skin), kCrease * cell_of(model, organ)));
  model.nearest_at_start.resize(model.nearest_at_start.size() + model.self_pairs.back().sample.size(), -1);
}

/// Where a body's samples are drawn, and which are held.
struct Samples {
  BodyId body;
  std::vector<Vec3d> place;
  std::vector<float> held;  ///< CarriedPair::kNever, or 0
};

std::vector<Samples> samples_of_bodies(const sim::Model& model) {
  std::vector<Samples> all;
  for (int i = 0; i < model.organs(); ++i) {
    Samples& s = all.emplace_back(Samples{BodyId::organ(size_t(i)), {}, {}});
    for (const Vec3f& p : model.skin(i).rest) s.place.push_back(vec_cast<double>(p));
    s.held.assign(s.place.size(), 0);
  }
  for (size_t i = 0; i < model.membranes.size(); ++i) {
    const tissue::NetworkModel& net = model.membranes[i].sheet.network;
    Samples& s = all.emplace_back(Samples{BodyId::membrane(i), net.rest, {}});
    for (size_t n = 0; n < net.rest.size(); ++n)
      s.held.push_back(net.fixed[n] == tissue::kHeld ? interactions::CarriedPair::kNever : 0.0f);
  }
  for (size_t i = 0; i < model.strand_bodies.size(); ++i) {
    const tissue::StrandModel& rod = model.strand_bodies[i].model;
    Samples& s = all.emplace_back(Samples{BodyId::strand(i), rod.rest, {}});
    for (const std::uint8_t p : rod.prescribed) s.held.push_back(p ? interactions::CarriedPair::kNever : 0.0f);
  }
  return all;
}

/// Samples of a pair as drawn are tested by that.
void leave_to_pairs(const sim::Model& model, interactions::CarriedPair& pair) {
  if (!pair.on.is(BodyKind::organ)) return;
  for (const interactions::SurfacePair& p : model.surface_pairs) {
    const BodyId whose = p.strand >= 0     ? BodyId::strand(size_t(p.strand))
                         : p.membrane >= 0 ? BodyId::membrane(size_t(p.membrane))
                                           : BodyId::organ(size_t(p.solid));
    if (whose != pair.body || p.surface != std::int32_t(pair.on.index())) continue;
    for (const std::int32_t sample : p.sample) pair.overlap[size_t(sample)] = pair.kNever;
  }
}

/// Vertices of the second that are next to where it hangs on the first.
std::vector<bool> bases_on(const sim::Model& model, BodyId body, BodyId on) {
  if (!on.is(BodyKind::membrane) || !body.is(BodyKind::organ)) return {};
  const sim::MembraneBody& m = model.membranes[on.index()];
  if (!carries(m, int(body.index()))) return {};
  std::vector<bool> next_to = away_from_base(m.sheet);
  next_to.flip();
  return next_to;
}

/// How far a sample lies in what it may be carried to, in the drawn shape. Organs are joined only with what hangs on
/// them; rods and membranes with all that they lie next to, and so is what lies next to an open membrane.
struct DrawnOverlap {
  const interactions::Surface& surface;
  const bool joins, two_sides;
  const double half;
  const std::vector<bool> bases;

  DrawnOverlap(const sim::Model& model, const Drawn& drawn, BodyId body, BodyId on)
      : surface(drawn.skin_of_body(on)),
        joins(!body.is(BodyKind::organ) || interactions::has_two_sides(model, on)),
        two_sides(interactions::has_two_sides(model, on)),
        half(on.is(BodyKind::organ) ? 0 : 0.5 * model.membranes[on.index()].sheet.thickness),
        bases(bases_on(model, body, on)) {}

  float of(Vec3d p) const {
    constexpr float kNever = interactions::CarriedPair::kNever;
    const int nearest = interactions::nearest_vertex(surface, p);
    if (!bases.empty() && bases[size_t(nearest)]) return kNever;
    if (joins && geometry::distance2(surface.position(nearest), p) < kTogether * kTogether) return kNever;
    if (two_sides) return 0;
    const double overlap = std::max(0.0, half - interactions::clearance_at(surface, nearest, p).distance);
    return overlap > interactions::kDeepestContact || (joins && overlap > 0) ? kNever : float(overlap);
  }
};

/// All that may be carried to a skin.
void pair_carried(sim::Model& model, const Drawn& drawn) {
  std::vector<BodyId> skins;
  for (int i = 0; i < model.organs(); ++i) skins.push_back(BodyId::organ(size_t(i)));
  for (size_t i = 0; i < model.membranes.size(); ++i) skins.push_back(BodyId::membrane(i));
  for (const Samples& s : samples_of_bodies(model))
    for (const BodyId on : skins) {
      if (on == s.body) continue;
      const tissue::Box& box = drawn.skin_of_body(on).pose->bounds;
      interactions::CarriedPair pair{s.body, on, s.held};
      leave_to_pairs(model, pair);
      const DrawnOverlap overlap(model, drawn, s.body, on);
      for (size_t k = 0; k < s.place.size(); ++k)
        if (pair.overlap[k] < pair.kNever && box.reaches(s.place[k], kTogether))
          pair.overlap[k] = overlap.of(s.place[k]);
      if (std::any_of(pair.overlap.begin(), pair.overlap.end(), [&](float o) { return o < pair.kNever; }))
        model.carried_pairs.push_back(std::move(pair));
    }
}

}  // namespace

void compile_contacts(sim::Model& model) {
  const Drawn drawn(model);
  const int organs = model.organs(), strands = int(model.strands.size());
  for (int i = 0; i < strands; ++i)
    for (int s = 0; s < model.surfaces(); ++s) pair_strand(model, drawn, i, s);
  for (int i = 0; i < organs; ++i)
    for (int s = 0; s < model.surfaces(); ++s)
      if (s >= organs && lattice_of(model, i) < 0)
        pair_cuttable(model, drawn, i, s);
      else if (s >= organs || s < i)
        pair_solid(model, drawn, i, s);
  for (int i = 0; i < int(model.membranes.size()); ++i)
    for (int s = 0; s < model.surfaces(); ++s) pair_membrane(model, drawn, i, s);
  for (int a = 0; a < strands; ++a)
    for (int b = a + 1; b < strands; ++b) pair_strands(model, a, b);
  for (int i = 0; i < organs; ++i) pair_self(model, drawn, i);
  pair_carried(model, drawn);
}

}  // namespace trocar::scene
