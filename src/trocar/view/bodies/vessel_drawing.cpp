#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/view/bodies/vessel_drawing.hpp>

namespace trocar::view {
namespace {

constexpr std::uint32_t kVesselAround = 8;
constexpr double kRing = 0.001;          // [m] from ring to ring
constexpr double kClipWide = 0.0014;     // [m] a clip narrows the vessel so far to either side
constexpr double kVesselBend = 0.005;    // [m] radius with which vessels curve, for rings that are left out ...
constexpr double kBendInFold = 0.002;    // ... in a fold, where they wind
constexpr double kBloody = 0.004;        // [m] of a stump
constexpr double kMostShift = 0.35;      // of the radius, however large the gain
constexpr double kNarrowed = 0.7;        // share of the radius that a clip takes
constexpr double kTaper = 0.008;         // [m] over which a vessel that ends thins out ...
constexpr double kTaperInFold = 0.016;   // ... in a fold
constexpr double kVesselThinnest = 0.2;  // share of the radius at such an end
constexpr double kInFold = 0.8;          // share of the radius: half of it is in the fold
constexpr double kSameNode = 0.0012;     // [m] ends that meet
constexpr int kVesselSofter = 8;         // passes that round the line's corners ...
constexpr int kSofterInFold = 22;        // ... in a fold, where nothing bends a vessel sharply
constexpr int kVesselWide = 15;          // of these reach twice as far
constexpr double kFade = 0.009;          // [m] over which one that ends in a fold is lost in it
constexpr double kMeeting = 0.009;       // [m] beside a place where vessels of a fold meet, that is rounded ...
constexpr double kVesselDrawnIn = 0.6;   // ... by this share of the mean of the ways there ...
constexpr double kMostDrawnIn = 0.0045;  // [m] ... at most
constexpr double kDives = 0.003;         // [m] seen of a vessel that leaves its fold
constexpr double kNestled = 0.82;        // radii below an organ's surface: hardly a ridge
constexpr double kTrunk = 1.2;           // of the radius, where a vessel of a fold comes from ...
constexpr double kTwig = 0.4;            // ... and at its other end: drawn the more uneven
constexpr double kBuried = 0.0045;       // [m] there, where a vessel of a fold goes into an organ
constexpr double kWinding = 0.0011;      // [m] to either side, in a fold

/// A line through places at s, cubic between them.
struct Curve {
  std::vector<double> s;
  std::vector<Vec3d> x;

  Vec3d slope(std::size_t k) const {
    const std::size_t a = k > 0 ? k - 1 : 0, b = std::min(k + 1, x.size() - 1);
    return (x[b] - x[a]) / std::max(s[b] - s[a], 1e-9);
  }
  Vec3d at(double v) const {
    std::size_t k = std::size_t(std::upper_bound(s.begin(), s.end(), v) - s.begin());
    k = std::clamp<std::size_t>(k, 1, s.size() - 1) - 1;
    const double h = std::max(s[k + 1] - s[k], 1e-9), t = std::clamp((v - s[k]) / h, 0.0, 1.0);
    const double t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * x[k] + (h * (t3 - 2 * t2 + t)) * slope(k) + (3 * t2 - 2 * t3) * x[k + 1] +
           (h * (t3 - t2)) * slope(k + 1);
  }
};

/// Places of the run's rings: vessels run in soft bends, and wind where a fold lets them.
template <class Run>
std::vector<Vec3d> drawn_line(const Run& run, const Curve& curve, const interactions::VesselPath& path) {
  std::vector<Vec3d> line, old;
  for (const double s : run.s) line.push_back(curve.at(s));
  for (int pass = 0; pass < (in_a_fold(path) ? kSofterInFold : kVesselSofter); ++pass) {
    old = line;
    const std::size_t wide = in_a_fold(path) && pass < kVesselWide ? 2 : 1, n = line.size();
    for (std::size_t i = 1; i + 1 < n; ++i) {
      const std::size_t far = std::min({wide, i, n - 1 - i});
      line[i] = 0.5 * old[i] + 0.25 * (old[i - far] + old[i + far]);
    }
  }
  if (!in_a_fold(path)) return line;
  old = line;
  Vec3d beside = any_perpendicular(normalised(line.back() - line.front()));
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    const Vec3d along = normalised(old[i + 1] - old[i - 1]);
    beside = normalised(beside - dot(beside, along) * along, any_perpendicular(along));
    const double way = run.s[i] * path.length, ends = std::min(run.s[i] - run.from, run.to - run.s[i]) * path.length;
    const double far = kWinding * smooth(0, 0.006, ends);
    line[i] += far * (std::sin(400 * way + 0.9 * std::sin(170 * way)) * beside +
                      std::sin(360 * way + 1.3) * cross(along, beside));
  }
  return line;
}

/// How high a place is over the nearest vertex of a skin as drawn, and that vertex' normal.
struct Over {
  double height;
  Vec3d normal;
};
Over over_skin(const tissue::Skin& skin, Vec3d p) {
  int best = 0;
  double least = 1e30;
  for (int v = 0; v < skin.size(); ++v) {
    const Vec3d off = p - vec_cast<double>(skin.rest[std::size_t(v)]);
    if (skin.at_surface(v) && dot(off, off) < least) least = dot(off, off), best = v;
  }
  const Vec3d normal = vec_cast<double>(skin.rest_normal[std::size_t(best)]);
  return {dot(p - vec_cast<double>(skin.rest[std::size_t(best)]), normal), normal};
}

/// A vessel that rides on an organ lies in its surface, one that a fold carries in the fold, from where it goes deep
/// into the organ: lines are drawn by hand and run up to some millimetres beside.
interactions::VesselPath nestled(interactions::VesselPath path, const interactions::Bodies& drawn) {
  const bool fold = in_a_fold(path);
  for (interactions::VesselPoint& p : path.points) {
    if (p.rides.body.is(BodyKind::organ) && !is_tetrahedral(drawn, p.rides.body)) {
      const Over at = over_skin(drawn.models.skin(int(p.rides.body.index())), p.drawn);
      const double down = at.height + (fold ? kBuried : kNestled * p.radius);
      if (down > 0) p.rides = attach(drawn, p.rides.body, p.drawn - down * at.normal);
    }
    if (p.rides.body.is(BodyKind::membrane)) p.rides.offset[2] = 0;
  }
  return path;
}

/// Share of the radius, less towards an end that leads nowhere.
template <class Run>
double thinned(const Run& run, double s, double length, double taper) {
  double share = 1;
  if (run.fades_from) share = std::min(share, smooth(0, taper, (s - run.from) * length));
  if (run.fades_to) share = std::min(share, smooth(0, taper, (run.to - s) * length));
  return kVesselThinnest + (1 - kVesselThinnest) * share;
}

/// From where to where on the line it does not run below the peritoneum.
/// Of one that a fold carries: in it, along the strand on its border, and on into the organ where it comes from, below
/// whose surface it is lost; elsewhere it goes into the depth.
std::pair<double, double> in_sight(const interactions::VesselPath& path) {
  const bool fold = in_a_fold(path);
  double from = 1, to = 0;
  for (const interactions::VesselPoint& p : path.points) {
    if (p.covered() || (fold && p.rides.in_space())) continue;
    from = std::min(from, p.s);
    to = std::max(to, p.s);
  }
  if (!fold) return {from, to};
  const double beyond = kDives / path.length;
  return {std::max(0.0, from - beyond), std::min(1.0, to + beyond)};
}

/// How much is to be seen of a vessel of a fold: none where it ends in that.
template <class Run>
double shown(const Run& run, double s, double length) {
  double share = 1;
  if (run.fades_from) share = std::min(share, smooth(0, kFade, (s - run.from) * length));
  if (run.fades_to) share = std::min(share, smooth(0, kFade, (run.to - s) * length));
  return share;
}

std::vector<double> sorted_cuts(const sim::State& state, int vessel) {
  std::array<double, interactions::kMaxOpenings> room;
  const std::span<const double> cuts = sim::cuts_of(state, vessel, room);
  std::vector<double> sorted(cuts.begin(), cuts.end());
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

}  // namespace

bool in_a_fold(const interactions::VesselPath& path) {
  return std::any_of(path.points.begin(), path.points.end(),
                     [](const interactions::VesselPoint& p) { return p.rides.body.is(BodyKind::membrane); });
}

bool is_in_sight(const interactions::VesselPath& path) {
  const auto [from, to] = in_sight(path);
  return from < to;
}

VesselDrawing::VesselDrawing(const sim::Model& model, bool veins, render::Backend& backend, const Detail& detail,
                             Lie lie)
    : m_model(&model), m_veins(veins), m_lie(lie) {
  for (const sim::DetailLevel& level : detail.levels()) m_errors.push_back(level.error);
  const sim::State state = sim::initial_state(model);
  for (const sim::Vessel& vessel : model.vessels.list)
    m_paths.push_back(nestled(vessel.path, sim::bodies_of(model, state)));
  lay_out(state);
  place(state);
  m_buffer.rest = m_buffer.positions;
  m_mesh = OwnedMesh(backend, m_buffer.data());
}

void VesselDrawing::update(const sim::State& state) {
  if (m_laid_out_for == state.opening_count) {
    place(state);
    m_mesh.update(m_buffer);
    return;
  }
  const sim::State drawn = sim::initial_state(*m_model);
  lay_out(state);
  place(drawn);  // patterns keep to the drawn shape
  m_buffer.rest = m_buffer.positions;
  place(state);
  m_mesh.replace(m_buffer.data());
}

/// Does another vessel continue from this end? Of a fold's vessels: one that is drawn in the fold, too.
bool VesselDrawing::leads_on(int vessel, int end) const {
  const auto end_of = [this](std::size_t v, int which) {
    const auto& points = m_model->vessels.list[v].path.points;
    return which == 0 ? points.front().drawn : points.back().drawn;
  };
  const Vec3d here = end_of(std::size_t(vessel), end);
  const bool fold = in_a_fold(m_model->vessels.list[std::size_t(vessel)].path);
  for (std::size_t v = 0; v < m_model->vessels.list.size(); ++v) {
    if (fold && !in_a_fold(m_model->vessels.list[v].path)) continue;
    for (const int other : {0, 1})
      if (int(v) != vessel && m_model->vessels.list[v].vein == m_veins && length(end_of(v, other) - here) < kSameNode)
        return true;
  }
  return false;
}

void VesselDrawing::lay_out(const sim::State& state) {
  m_laid_out_for = state.opening_count;
  m_runs.clear();
  m_buffer = {};
  for (std::size_t v = 0; v < m_model->vessels.list.size(); ++v) {
    const sim::Vessel& vessel = m_model->vessels.list[v];
    if (vessel.vein != m_veins) continue;
    const bool some = m_lie == Lie::in_a_fold || m_lie == Lie::elsewhere;
    if (some && in_a_fold(vessel.path) != (m_lie == Lie::in_a_fold)) continue;
    const auto [begin, end] = m_lie == Lie::below_too ? std::pair(0.0, 1.0) : in_sight(vessel.path);
    std::vector<double> ends = sorted_cuts(state, int(v));
    ends.push_back(end);
    double from = begin;
    for (std::size_t k = 0; k < ends.size() && from < end; ++k) {
      Run run;
      run.vessel = int(v);
      run.from = from;
      run.to = std::min(ends[k], end);
      run.cut_from = k > 0;
      run.cut_to = k + 1 < ends.size();
      run.first = m_buffer.size();
      run.fades_from = !run.cut_from && (begin > 0 || !leads_on(int(v), 0));
      run.fades_to = !run.cut_to && (end < 1 || !leads_on(int(v), 1));
      from = std::max(from, ends[k]);
      const double way = (run.to - run.from) * vessel.path.length;
      if (way < 1e-4) continue;
      const int steps = std::max(2, int(way / kRing + 0.5));
      for (int i = 0; i <= steps; ++i) run.s.push_back(run.from + (run.to - run.from) * i / steps);
      for (std::size_t i = 0; i < run.s.size() * kVesselAround + 2; ++i) m_buffer.add({});
      m_runs.push_back(std::move(run));
    }
  }
  for (const Run& run : m_runs) join(run, 1, 1, m_buffer);
  for (const double error : m_errors) {
    MeshBuffer part;
    for (const Run& run : m_runs) {
      const interactions::VesselPath& path = m_model->vessels.list[std::size_t(run.vessel)].path;
      const double bend = in_a_fold(path) ? kBendInFold : kVesselBend;
      const auto apart = std::max<std::size_t>(1, std::size_t(ring_distance(error, bend) / kRing));
      const double radius = std::max(vessel_radius(path, run.from), vessel_radius(path, run.to));
      join(run, apart, side_stride(error, radius, kVesselAround), part);
    }
    m_buffer.coarser.push_back(std::move(part.indices));
  }
  m_buffer.normals.resize(m_buffer.positions.size());
  m_pressure.resize(m_buffer.positions.size());
}

/// Triangles of every so many rings and sides.
void VesselDrawing::join(const Run& run, std::size_t rings_apart, std::uint32_t stride, MeshBuffer& into) const {
  const std::size_t last = run.s.size() - 1;
  const auto ring = [&](std::size_t i) { return run.first + std::uint32_t(i) * kVesselAround; };
  const std::uint32_t poles = ring(run.s.size());
  for (std::uint32_t k = 0; k < kVesselAround; k += stride) {
    const std::uint32_t next = (k + stride) % kVesselAround;
    into.triangle(ring(0) + next, ring(0) + k, poles);
    for (std::size_t i = 0; i < last; i += rings_apart) {
      const std::size_t j = std::min(i + rings_apart, last);
      into.quad(ring(i) + k, ring(i) + next, ring(j) + next, ring(j) + k);
    }
    into.triangle(ring(last) + k, ring(last) + next, poles + 1);
  }
}

void VesselDrawing::place(const sim::State& state) {
  const interactions::Bodies bodies = sim::bodies_of(*m_model, state);
  std::vector<Vec3d> points;
  int posed = -1;
  for (Run& run : m_runs) {
    const interactions::VesselPath& path = m_model->vessels.list[std::size_t(run.vessel)].path;
    if (posed != run.vessel) {
      points.resize(path.points.size());
      pose_vessel(m_paths[std::size_t(run.vessel)], bodies, points);
      posed = run.vessel;
    }
    run.line = line_of(run, state, points);
  }
  round_meetings();
  for (const Run& run : m_runs) place_run(run, state);
}

/// Where vessels meet in a fold they run into each other in a bow, not in a corner: the place is drawn towards where
/// they come from, and what is beside it follows.
void VesselDrawing::round_meetings() {
  struct End {
    Run* run;
    bool last;
    Vec3d place, arm;  ///< arm: from there to a point of the line that is kMeeting away
  };
  std::vector<End> ends;
  for (Run& run : m_runs) {
    if (!in_a_fold(m_model->vessels.list[std::size_t(run.vessel)].path)) continue;
    const std::size_t n = run.line.size(), far = std::min(n - 1, std::size_t(kMeeting / kRing));
    if (!run.cut_from && !run.fades_from) ends.push_back({&run, false, run.line[0], run.line[far] - run.line[0]});
    if (!run.cut_to && !run.fades_to)
      ends.push_back({&run, true, run.line[n - 1], run.line[n - 1 - far] - run.line[n - 1]});
  }
  for (const End& end : ends) {
    Vec3d sum{};
    int meeting = 0;
    for (const End& other : ends)
      if (length(other.place - end.place) < kSameNode) sum += other.arm, ++meeting;
    if (meeting < 2) continue;
    Vec3d shift = (kVesselDrawnIn / meeting) * sum;
    shift = std::min(1.0, kMostDrawnIn / std::max(length(shift), 1e-9)) * shift;
    for (std::size_t i = 0; i < end.run->line.size(); ++i) {
      const std::size_t from_end = end.last ? end.run->line.size() - 1 - i : i;
      end.run->line[i] += smooth(kMeeting, 0, kRing * double(from_end)) * shift;
    }
  }
}

/// Places of its rings.
std::vector<Vec3d> VesselDrawing::line_of(const Run& run, const sim::State& state,
                                          std::span<const Vec3d> points) const {
  const interactions::VesselPath& path = m_model->vessels.list[std::size_t(run.vessel)].path;
  const std::vector<double> cuts = sorted_cuts(state, run.vessel);
  Curve curve;
  const auto take = [&](double s, Vec3d x) {
    curve.s.push_back(s);
    curve.x.push_back(x);
  };
  take(run.from, vessel_spot(path, points, cuts, run.from, 1).place);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (path.points[i].s > run.from + 1e-6 && path.points[i].s < run.to - 1e-6) take(path.points[i].s, points[i]);
  take(run.to, vessel_spot(path, points, cuts, run.to, 0).place);

  return drawn_line(run, curve, path);
}

void VesselDrawing::place_run(const Run& run, const sim::State& state) {
  const sim::Vessel& vessel = m_model->vessels.list[std::size_t(run.vessel)];
  const interactions::VesselPath& path = vessel.path;
  const bool fold = in_a_fold(path);
  const std::vector<Vec3d>& line = run.line;
  Vec3d tangent = normalised(line[1] - line[0]), normal = any_perpendicular(tangent);
  for (std::size_t i = 0; i < run.s.size(); ++i) {
    const double s = run.s[i];
    tangent = normalised(line[std::min(i + 1, line.size() - 1)] - line[i > 0 ? i - 1 : 0], tangent);
    normal = normalised(normal - dot(normal, tangent) * tangent, any_perpendicular(tangent));
    const Vec3d beside = cross(tangent, normal), at = line[i];
    const double in_fold = kInFold * (kTrunk + (kTwig - kTrunk) * s);
    const double drawn =
        (fold ? in_fold : 1) * vessel_radius(path, s) * thinned(run, s, path.length, fold ? kTaperInFold : kTaper);
    const vessels::WallReading wall = read_wall(m_model->vessels.flow, state.flow, run.vessel, s, vessel.gain);
    double radius = drawn + std::clamp(wall.shift, -kMostShift * drawn, kMostShift * drawn);
    for (int c = 0; c < state.vessel_clip_count; ++c) {
      const interactions::VesselClip& clip = state.vessel_clips[std::size_t(c)];
      if (clip.vessel != run.vessel) continue;
      const double cover = cover_at(clip, sim::kTick * double(state.tick - clip.tick));
      radius *= 1 - kNarrowed * cover * smooth(2 * kClipWide, kClipWide, std::fabs(s - clip.s) * path.length);
    }
    double bloody = 0;
    if (run.cut_from) bloody = smooth(kBloody, 0, (s - run.from) * path.length);
    if (run.cut_to) bloody = std::max(bloody, smooth(kBloody, 0, (run.to - s) * path.length));
    for (std::uint32_t k = 0; k < kVesselAround; ++k) {
      const double angle = 2 * portable::pi * k / kVesselAround;
      const Vec3d out = std::cos(angle) * normal + std::sin(angle) * beside;
      const std::size_t vertex = run.first + i * kVesselAround + k;
      m_buffer.positions[vertex] = vec_cast<float>(at + radius * out);
      m_buffer.normals[vertex] = vec_cast<float>(out);
      m_buffer.paint[vertex].blood = to_byte(0.8 * bloody);
      if (fold) m_buffer.paint[vertex].openness = to_byte(shown(run, s, path.length));
      m_pressure[vertex] = float(wall.pressure);
    }
    if (i > 0 && i + 1 < run.s.size()) continue;
    const double end = i == 0 ? -1 : 1;
    const std::size_t pole = run.first + run.s.size() * kVesselAround + (i == 0 ? 0 : 1);
    const bool cut = i == 0 ? run.cut_from : run.cut_to;  // the lumen shows as a dimple
    m_buffer.positions[pole] = vec_cast<float>(at + ((cut ? -0.5 : 0.5) * end * radius) * tangent);
    m_buffer.normals[pole] = vec_cast<float>(end * tangent);
    m_buffer.paint[pole].blood = cut ? 255 : 0;
    if (fold) m_buffer.paint[pole].openness = to_byte(shown(run, s, path.length));
    m_pressure[pole] = float(wall.pressure);
  }
}

}  // namespace trocar::view
