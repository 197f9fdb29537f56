#include <algorithm>

#include <trocar/interactions/verbs/cut.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/view/base/looks.hpp>
#include <trocar/view/base/pinch.hpp>
#include <trocar/view/fluids/blood_run.hpp>
#include <trocar/view/fluids/film_splats.hpp>
#include <trocar/view/fluids/wet_drawing.hpp>

namespace trocar::view {

namespace {

constexpr double kLeastPlace = 1e-6;     // [m^2]
constexpr double kStrandReach = 0.0025;  // [m] a place this near to a strand's surface lies on it

/// A third of the triangles around each vertex, as drawn.
std::vector<double> areas_around(const tissue::Skin& skin) {
  std::vector<double> areas(skin.rest.size());
  for (const std::array<int, 3>& t : skin.triangles) {
    const Vec3d a = vec_cast<double>(skin.rest[std::size_t(t[0])]);
    const Vec3d u = vec_cast<double>(skin.rest[std::size_t(t[1])]) - a,
                v = vec_cast<double>(skin.rest[std::size_t(t[2])]) - a;
    for (const int vertex : t) areas[std::size_t(vertex)] += length(cross(u, v)) / 6;
  }
  return areas;
}

/// The lower half of a strand around each node.
std::vector<double> areas_below(const interactions::StrandBody& strand) {
  const std::vector<Vec3d>& rest = strand.model.rest;
  std::vector<double> areas(rest.size());
  for (std::size_t i = 0; i + 1 < rest.size(); ++i) {
    const double half = 0.5 * portable::pi * strand.model.radius[i] * length(rest[i + 1] - rest[i]);
    areas[i] += half, areas[i + 1] += half;
  }
  return areas;
}

/// Is the end of a strand on that side of a cut shut by a clip? Then no blood comes out of it.
bool shut(const sim::State& state, const interactions::Cut& cut, double side) {
  return std::any_of(state.clips.begin(), state.clips.begin() + state.clip_count, [&](const interactions::Clip& clip) {
    return clip.strand == cut.strand && (clip.s - cut.s) * side > 0 && closes_end(clip, cut.s);
  });
}

}  // namespace

WetDrawing::WetDrawing(const sim::Model& model) : m_model(&model), m_drawing(model.wet.model) {
  for (int i = 0; i < model.organs(); ++i) m_poses.push_back(tissue::make_pose(model.skin(i)));
  for (const sim::MembraneBody& m : model.membranes) m_poses.push_back(tissue::make_pose(m.skin));
  m_bodies.surfaces.resize(std::size_t(model.surfaces()));
  m_bodies.membranes.resize(model.membranes.size());
  m_places.resize(std::size_t(model.wet.film.back()));
  m_sheer.resize(model.wet.film.size() - 1);
  const interactions::WetOrder order(m_bodies.surfaces.size(), model.membranes.size());
  for (std::size_t i = 0; i < model.membranes.size(); ++i)
    m_sheer[std::size_t(order.sheet(i))] = look(model, model.membranes[i].look).translucent;
  measure_places();
}

void WetDrawing::measure_places() {
  const auto put = [this](std::size_t body, const std::vector<double>& areas, int sides) {
    const std::size_t first = std::size_t(m_model->wet.film[body]);
    for (std::size_t v = 0; v < areas.size(); ++v)
      for (int side = 0; side < sides; ++side)
        m_places[first + v * std::size_t(sides) + std::size_t(side)].area = float(std::max(areas[v], kLeastPlace));
  };
  std::size_t body = 0;
  for (int i = 0; i < m_model->organs(); ++i) put(body++, areas_around(m_model->skin(i)), 1);
  for (const sim::WallModel& wall : m_model->walls) put(body++, areas_around(wall.skin), 1);
  for (const sim::MembraneBody& m : m_model->membranes) put(body++, areas_around(m.skin), 2);
  for (const interactions::StrandBody& strand : m_model->strand_bodies) put(body++, areas_below(strand), 1);
}

void WetDrawing::pose(const sim::State& state) {
  const std::size_t organs = std::size_t(m_model->organs());
  for (std::size_t i = 0; i < organs; ++i) {
    const tissue::NodeView nodes = nodes_of(*m_model, state, int(i));
    pose_skin(nodes, m_model->skin(int(i)), m_poses[i]);
    m_bodies.surfaces[i] = {&m_model->skin(int(i)), &m_poses[i], nodes};
  }
  for (std::size_t i = 0; i < m_model->walls.size(); ++i)
    m_bodies.surfaces[organs + i] = {&m_model->walls[i].skin, &m_model->walls[i].pose, {}};
  for (std::size_t i = 0; i < m_bodies.membranes.size(); ++i) {
    const sim::MembraneBody& m = m_model->membranes[i];
    const tissue::NodeView nodes = view_of(m.sheet.network, state.membranes[i].network);
    pose_skin(nodes, m.skin, m_poses[organs + i]);
    m_bodies.membranes[i].sheet = {{&m.skin, &m_poses[organs + i], nodes},
                                   state.torn[i],
                                   m.sheet.network.fixed,
                                   0.5 * m.sheet.thickness,
                                   m.pinch_reach};
  }
}

void WetDrawing::list(const sim::State& state, render::Frame& frame) {
  pose(state);
  const interactions::WetGround ground{{*m_model, state, &m_bodies}, m_model->wet.film};
  const Vec3d down = normalised(m_model->gravity, {0, 0, -1});
  for (std::size_t i = 0; i < m_places.size(); ++i) {
    if (state.fluids.droplets.film[i].total() == 0) continue;
    const interactions::WetPlace at = wet_place(ground, down, std::int32_t(i));
    const bool sheer = at.body >= 0 && m_sheer[std::size_t(at.body)] != 0;
    m_places[i] = {vec_cast<float>(at.point), vec_cast<float>(at.normal), m_places[i].area, sheer};
  }
  const auto surface = [&](const FilmPlace& place) { return on_strand(state, place); };
  m_drawing.list({state.fluids, state.pool_floor, m_places, m_sheer, surface}, frame);
  list_stumps(state, frame.liquid);
  list_runs(state, frame.liquid);
}

/// From every opening of a vessel, also when it bleeds no more.
void WetDrawing::list_runs(const sim::State& state, render::Liquid& liquid) {
  if (state.opening_count == 0) return;
  const interactions::Bodies bodies = sim::bodies_of(*m_model, state);
  std::vector<Vec3d> points;
  for (int i = 0; i < state.opening_count; ++i) {
    const interactions::VesselOpening& opening = state.openings[std::size_t(i)];
    const sim::Vessel& vessel = m_model->vessels.list[std::size_t(opening.vessel)];
    points.resize(vessel.path.points.size());
    pose_vessel(vessel.path, bodies, points);
    BloodRun run;
    run.wound = vessel_spot(vessel.path, points, {}, opening.s).place;
    run.since = sim::kTick * double(state.tick - std::min(state.tick, opening.tick));
    fluids::Blood blood;
    blood.venous = vessel.vein ? 1.0f : 0.0f;
    run.dark = darkness(float(run.since), blood, {1, 0, 0});
    list_run(run, m_model->wet.model.pool, state.fluids.pool, state.pool_floor, liquid);
  }
}

/// Both ends of every strand that is cut through.
void WetDrawing::list_stumps(const sim::State& state, render::Liquid& liquid) const {
  for (int n = 0; n < state.cut_count; ++n) {
    const interactions::Cut& cut = state.cuts[std::size_t(n)];
    if (cut.strand < 0 || cut.fraction < interactions::kThrough) continue;
    const interactions::StrandBody& body = m_model->strand_bodies[std::size_t(cut.strand)];
    const std::vector<Vec3d>& x = state.strands[std::size_t(cut.strand)].x;
    const interactions::StrandPlace place = interactions::place_at(body, cut.s);
    const std::size_t e = std::size_t(place.element);
    const double element = length(body.model.rest[e + 1] - body.model.rest[e]);
    const auto stump = [&](std::size_t at, std::size_t before, double beyond) {
      // Stumps are drawn as long as the tube was there.
      const Vec3d out = normalised(x[at] - x[before], {1, 0, 0});
      const FilmPlace end{vec_cast<float>(x[at] + beyond * out), vec_cast<float>(out)};
      const Wound wound{liquid.down, {1, 0, 0}, 1};
      list_stump(wound, end, float(body.model.radius[std::min(e, body.model.radius.size() - 1)]), liquid);
    };
    const bool oozes = m_model->strands[std::size_t(cut.strand)].fimbriated;  // though shut: its wall is all muscle
    if (e > 0 && (oozes || !shut(state, cut, -1))) stump(e, e - 1, place.w * element);
    if (e + 2 < x.size() && (oozes || !shut(state, cut, 1))) stump(e + 1, e + 2, (1 - place.w) * element);
  }
}

/// A place next to strands, laid on the surface of all of them: that of the one it is deepest in.
FilmPlace WetDrawing::on_strand(const sim::State& state, const FilmPlace& place) const {
  const Vec3d p = vec_cast<double>(place.position);
  double nearest = kStrandReach;
  FilmPlace found = place;
  for (std::size_t i = 0; i < m_model->strand_bodies.size(); ++i) {
    const std::vector<Vec3d>& x = state.strands[i].x;
    for (std::size_t k = 0; k + 1 < x.size(); ++k) {
      const Vec3d way = x[k + 1] - x[k];
      const double t = std::clamp(dot(p - x[k], way) / std::max(dot(way, way), 1e-12), 0.0, 1.0);
      const Vec3d axis = x[k] + t * way, out = normalised(p - axis, vec_cast<double>(place.normal));
      const double radius = m_model->strand_bodies[i].model.radius[k], off = length(p - axis) - radius;
      if (off >= nearest) continue;
      nearest = off;
      found.position = vec_cast<float>(axis + radius * out);
      found.normal = vec_cast<float>(out);
    }
  }
  return found;
}

}  // namespace trocar::view
