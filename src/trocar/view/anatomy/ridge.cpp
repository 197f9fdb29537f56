#include <algorithm>
#include <cmath>
#include <utility>

#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/view/anatomy/ridge.hpp>
#include <trocar/view/base/relief.hpp>
#include <trocar/view/bodies/cavity.hpp>

namespace trocar::view {
namespace {

constexpr int kRidgeRows = 12;         // ligament to wall
constexpr double kRidgeStep = 0.0028;  // [m] between stations
constexpr double kFrom = 0.10;         // share of the ligament where the fold below it begins ...
constexpr double kDown = 0.72;         // ... and where it has come down to the wall
constexpr double kWidest = 0.016;      // [m] from below the ligament to a flank's foot
constexpr double kRidgeOver = 0.62;    // share of the ligament from where on its flanks close over it ...
constexpr double kClosed = 0.86;       // ... and where they have
constexpr double kOverAll = 0.12, kClosedAll = 0.32;  // the same where it carries nothing
constexpr double kFromAll = -0.12, kDownAll = 0.24;
constexpr double kLostOver = 0.034;           // [m] of wall along which a ridge goes down and is lost ...
constexpr double kLostDepth = 0.0014;         // [m] ... below it
constexpr double kShallow = 3.0;              // radii of the ligament that it rises above it before that
constexpr double kShallowLaden = 0.4;         // the same of one that carries something
constexpr double kFlatter = 1.2;              // and how much rounder it grows
constexpr double kTurns = 8;                  // radii above the wall where its sections begin to turn
constexpr double kCrest = 1.15;               // radii from the ligament's axis to what covers it
constexpr double kCovers = 1.32;              // radii from the axis: nearer than that it would not cover the ligament
constexpr double kRidgeAround = 6.5;          // radii: how far its slope is that of the ligament's side
constexpr double kAroundAll = 16;             // the same of one that carries nothing: broad shoulders
constexpr double kWidestAll = 0.036;          // [m] and its feet
constexpr double kRidgeHeadOn = 0.75;         // sine of the angle to the wall
constexpr double kRidgeLoose = 0.0004;        // [m] what covers a ligament keeps off it
constexpr double kRidgeTucked = 0.0012;       // [m] the border lies below the wall
constexpr double kAtWall = 0.006;             // [m] nearer than that, down is the wall's normal
constexpr int kRidgeInWall = 2, kGlide = 12;  // stations where the ligament is in the wall, and beyond its end

/// Is it what folds hang on, or does a vessel run in it?
bool carries(const sim::Model& model, int strand) {
  const auto rides = [strand](const interactions::VesselPoint& p) {
    return p.rides.body == BodyId::maybe(BodyKind::strand, strand);
  };
  return std::any_of(model.drawn_folds.begin(), model.drawn_folds.end(),
                     [&](const auto& s) { return s.strand == strand; }) ||
         std::any_of(model.vessels.list.begin(), model.vessels.list.end(), [&](const sim::Vessel& v) {
           return std::any_of(v.path.points.begin(), v.path.points.end(), rides);
         });
}

/// Of a row, from the ligament to the wall; the last is tucked in.
double share_down(int row) { return std::min(1.0, double(row) / (kRidgeRows - 2)); }

/// A point that is at least so far from an axis.
Vec3d outside(Vec3d p, Vec3d axis, Vec3d along, double far) {
  const Vec3d off = p - axis - dot(p - axis, along) * along;
  const double now = length(off);
  return now < 1e-6 || now >= far ? p : p + (far / now - 1) * off;
}

}  // namespace

Ridge::Ridge(const sim::Model& model, const TubeDrawing& tube, int strand, const WallSurface& walls,
             render::Backend& backend, const Detail& detail)
    : m_body(&model.strand_bodies[std::size_t(strand)]),
      m_strand(strand),
      m_covered(!carries(model, strand)),
      m_marks(model, BodyId::strand(std::size_t(strand))) {
  const tissue::StrandState rest = tissue::rest_state(m_body->model);
  const StrandPiece all{0, m_body->nodes() - 1, 0, m_body->length(), false, false};
  const StrandCurve curve(*m_body, rest, {&all, 1});
  const double length_of = m_body->length();
  const int steps = std::max(6, int((1 - kFrom) * length_of / kRidgeStep));
  for (int i = 0; i <= steps; ++i) {
    Station st;
    st.s = length_of * (kFrom + (1 - kFrom) * i / steps);
    const CurveFrame f = curve.at(0, st.s);
    st.at = f.point;
    st.along = f.tangent;
    const auto node = std::size_t(place_at(*m_body, st.s).element);
    const std::vector<double>& outer = model.strands[std::size_t(strand)].outer;
    st.radius = 1.06 * std::max(outer[node], outer[node + 1]) + kRidgeLoose;
    m_stations.push_back(st);
  }
  add_root(tube.end_root());
  add_glide(walls);
  find_feet(walls);
  for (int i = 0; i < 2 * int(m_stations.size()) * kRidgeRows; ++i) m_buffer.add({});
  const auto row = [this](std::size_t flank, std::size_t i) {
    return std::uint32_t((flank * m_stations.size() + i) * kRidgeRows);
  };
  for (const std::size_t flank : {0u, 1u})
    for (std::size_t i = 0; i + 1 < m_stations.size(); ++i)
      join_rows(m_buffer, row(flank, flank ? i : i + 1), row(flank, flank ? i + 1 : i), kRidgeRows, false);
  place(curve);
  paint();
  m_buffer.rest = m_buffer.positions;
  coarsen(m_buffer, detail, kBends);
  m_mesh = OwnedMesh(backend, m_buffer.data());
}

bool Ridge::meets_head_on(const sim::Model& model, const TubeDrawing& tube, int strand, const WallSurface& walls) {
  const TubeNeck& neck = tube.neck(false);
  return neck.far > 0 && carries(model, strand) && dot(neck.along, walls.nearest(neck.end).normal) < -kRidgeHeadOn;
}

/// On along the ligament's way into the wall, which stays in space.
void Ridge::add_root(const TubeRoot& root) {
  const Station last = m_stations.back();
  const Vec3d a = last.at, da = root.length * last.along, b = root.target, db = root.length * root.direction;
  for (int i = 1; i <= kRidgeInWall; ++i) {
    const double t = double(i) / kRidgeInWall, u = 1 - t;
    Station st = last;
    st.beyond = true;
    st.at = (u * u * (1 + 2 * t)) * a + (t * t * (3 - 2 * t)) * b + (u * u * t) * da - (t * t * u) * db;
    st.along = normalised((6 * t * u) * (b - a) + (u * (1 - 3 * t)) * da + (t * (3 * t - 2)) * db, st.along);
    m_stations.push_back(st);
  }
}

/// How high its crest is above the wall that it runs out on, at least [m].
double Ridge::crest_above(const Station& st) const {
  const double left = (1 - st.gone) * (1 - st.gone);
  return (m_covered ? kShallow : kShallowLaden) * st.radius / (1 + kFlatter * st.gone) * left - kLostDepth * (1 - left);
}

/// Then on along the wall, down to below it.
void Ridge::add_glide(const WallSurface& walls) {
  const Station last = m_stations.back();
  Vec3d on = walls.nearest(last.at).point,
        onward = on - walls.nearest(m_stations[m_stations.size() - 1 - kRidgeInWall - 3].at).point;
  onward = normalised(onward, last.along);
  for (int i = 1; i <= kGlide; ++i) {
    const WallSurface::Place wall = walls.nearest(on + (kLostOver / kGlide) * onward);
    onward = normalised(wall.point - on, onward);
    on = wall.point;
    Station st = last;
    st.beyond = true;
    st.gone = double(i) / kGlide;
    st.radius *= 1 + kFlatter * st.gone;
    st.at = on + (crest_above(st) - kCrest * st.radius) * wall.normal;
    st.along = onward;
    m_stations.push_back(st);
  }
}

/// The wall below each station and to both sides; neighbours even each other out, then lie on the wall again.
void Ridge::find_feet(const WallSurface& walls) {
  const std::size_t n = m_stations.size();
  const auto even_out = [&](int passes, auto&& get) {
    for (int pass = 0; pass < passes; ++pass)
      for (std::size_t i = 0; i < n; ++i) {
        const std::size_t before = i > 0 ? i - 1 : 0, after = std::min(i + 1, n - 1);
        get(m_stations[i]) = 0.4 * get(m_stations[i]) + 0.3 * (get(m_stations[before]) + get(m_stations[after]));
      }
  };
  for (Station& st : m_stations) st.floor = walls.nearest(st.at).point;
  even_out(6, [](Station& st) -> Vec3d& { return st.floor; });
  for (Station& st : m_stations) {  // its crest does not dive: it goes down to the wall and on along that
    const WallSurface::Place wall = walls.nearest(st.at);
    const double crest = dot(st.at - wall.point, wall.normal) + kCrest * st.radius;
    st.lift = std::max(0.0, crest_above(st) - crest) * wall.normal;
  }
  settle_beyond();
  bool in_wall = false;
  double to_wall = m_body->length();  // of the ligament
  for (Station& st : m_stations) {
    const WallSurface::Place below = walls.nearest(st.floor);
    st.floor = below.point;
    st.normal[0] = st.normal[1] = below.normal;
    if (!in_wall && dot(st.at - st.floor, below.normal) < 0.4 * st.radius) {
      in_wall = true;
      to_wall = std::min(to_wall, st.s);
    }
    // Sections of what comes down steeply would cross those of what runs on along the wall: they turn in time.
    const double upright = smooth(kTurns * st.radius, st.radius, dot(st.at - st.floor, below.normal));
    st.along = normalised(st.along - upright * dot(st.along, below.normal) * below.normal, st.along);
    const Vec3d down = st.beyond ? -below.normal : st.floor - st.at - kAtWall * below.normal;
    st.side = normalised(cross(st.along, normalised(down, -below.normal)), any_perpendicular(st.along));
  }
  for (Station& st : m_stations) {
    st.depth = m_covered ? smooth(kFromAll, kDownAll, st.s / to_wall) : smooth(kFrom, kDown, st.s / to_wall);
    st.over = m_covered ? smooth(kOverAll, kClosedAll, st.s / to_wall) : smooth(kRidgeOver, kClosed, st.s / to_wall);
  }
  even_out(4, [](Station& st) -> Vec3d& { return st.side; });
  for (std::size_t i = 0; i < n; ++i) {
    Station& st = m_stations[i];
    st.side = normalised(st.side, any_perpendicular(st.along));
    const double high = std::max(0.0, dot(st.at - st.floor, st.normal[0]));
    const double uneven = 1 + 0.3 * waves(st.floor, 0.021);
    const double wide =
        (st.beyond ? 1.5 : 1.0) *
        std::min(m_covered ? kWidestAll : kWidest, 1.6 * st.radius + 0.002 + (m_covered ? 1.1 : 0.5) * high) * uneven;
    for (const int flank : {0, 1}) st.foot[flank] = st.floor + ((flank ? -wide : wide)) * st.side;
  }
  for (const int flank : {0, 1}) {
    even_out(14, [flank](Station& st) -> Vec3d& { return st.foot[flank]; });
    for (Station& st : m_stations) {
      const WallSurface::Place at = walls.nearest(st.foot[flank]);
      st.foot[flank] = at.point;
      st.normal[flank] = at.normal;
    }
  }
}

/// What stays in space is raised for good, and evened out.
void Ridge::settle_beyond() {
  for (Station& st : m_stations)
    if (st.beyond) st.at += std::exchange(st.lift, Vec3d{});
  for (int pass = 0; pass < 3; ++pass)
    for (std::size_t i = 1; i + 1 < m_stations.size(); ++i)
      if (m_stations[i].beyond)
        m_stations[i].at =
            0.4 * m_stations[i].at + 0.3 * (m_stations[i - 1].at + m_stations[i - 1].lift + m_stations[i + 1].at);
  for (std::size_t i = 1; i < m_stations.size(); ++i) {  // the ligament dives into the wall, the ridge runs along it
    Station& st = m_stations[i];
    const Station &before = m_stations[i - 1], &after = m_stations[std::min(i + 1, m_stations.size() - 1)];
    if (st.beyond) st.along = normalised(after.at - before.at - before.lift, st.along);
  }
}

/// One crest, no seam, where the flanks meet.
void Ridge::even_crest(std::size_t i) {
  const double over = smooth(0.8, 1, m_stations[i].over);
  if (over <= 0) return;
  Vec3f& left = m_buffer.normals[i * kRidgeRows];
  Vec3f& right = m_buffer.normals[(m_stations.size() + i) * kRidgeRows];
  const Vec3f mean = normalised(left + right, left);
  left = normalised((1 - float(over)) * left + float(over) * mean, left);
  right = normalised((1 - float(over)) * right + float(over) * mean, right);
}

void Ridge::place(const StrandCurve& curve) {
  const std::span<const StrandPiece> pieces = curve.pieces();
  for (std::size_t i = 0; i < m_stations.size(); ++i) {
    const Station& st = m_stations[i];
    int piece = int(pieces.size()) - 1;
    while (piece > 0 && pieces[std::size_t(piece)].from > st.s) --piece;
    const Vec3d at = (st.beyond ? st.at : curve.at(piece, st.s).point) + st.lift;
    for (const int flank : {0, 1})
      place_flank(st, at, flank, (std::size_t(flank) * m_stations.size() + i) * kRidgeRows);
  }
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
  for (std::size_t i = 0; i < m_stations.size(); ++i) even_crest(i);
  for (std::size_t i = 0; i < m_stations.size(); ++i)  // no seam: as the wall's, where it is down there
    for (const std::size_t flank : {0u, 1u}) {
      const Vec3f n = vec_cast<float>(m_stations[i].normal[flank]);
      const std::size_t first = (flank * m_stations.size() + i) * kRidgeRows;
      const double down = smooth(0.9, 1, m_stations[i].depth);
      for (std::size_t r = kRidgeRows - 4; r < kRidgeRows; ++r) {
        Vec3f& own = m_buffer.normals[first + r];
        const float w = float(down) * std::min(1.0f, float(r + 5 - kRidgeRows) / 3);
        if (dot(own, n) < 0) own = -own;
        own = normalised((1 - w) * own + w * n, n);
      }
    }
}

/// From the ligament's side, below its crest, to the wall.
void Ridge::place_flank(const Station& st, Vec3d at, int flank, std::size_t first) {
  const double sign = flank ? -1 : 1;
  const Vec3d n = st.normal[flank];
  const Vec3d mean = normalised(st.normal[0] + st.normal[1], n);
  const Vec3d down = normalised(st.floor - at - kAtWall * mean, -mean), out = sign * st.side;
  const Vec3d away = 0.15 * mean - down, up = normalised(away - dot(away, st.along) * st.along, -down);
  const double high = 0.5 + (kCrest - 0.5) * st.over,
               wide = std::sqrt(std::max(0.0, 1 - 0.87 * high * high * (1 - st.over) - st.over));
  const double hold = 0.8 + 0.2 * st.over;  // begins inside the ligament, whose outline is uneven
  const Vec3d top = at + st.radius * ((hold * wide) * out + (hold * high) * up);
  const Vec3d keel = at + std::max(0.6 * st.radius, st.depth * length(st.floor - at)) * down;
  const double spread = smooth(0.55, 1, st.depth);
  const Vec3d end = keel + spread * (st.foot[flank] - keel);
  const Vec3d level = normalised(out - dot(out, n) * n, out);
  const double reach = length(end - top);
  // Narrow above, hollow below: it leaves the ligament around that and arrives flat on the wall.
  const double round = std::min(reach, (m_covered ? kAroundAll : kRidgeAround) * st.radius);
  const Vec3d leaves = (reach + st.over * (round - reach)) *
                       normalised((0.49 + 0.5 * st.over) * out + (0.87 - 0.6 * st.over) * down),
              arrives = ((0.9 + 0.4 * st.over) * spread * reach) * level;
  for (int r = 0; r < kRidgeRows; ++r) {
    const double t = share_down(r), u = 1 - t;
    Vec3d p = (u * u * (1 + 2 * t)) * top + (t * t * (3 - 2 * t)) * end + (u * u * t) * leaves - (t * t * u) * arrives;
    p = outside(p, at, st.along, kCovers * st.over * st.radius);
    if (r == kRidgeRows - 1) p = end + spread * (0.002 * level - kRidgeTucked * n);
    const std::size_t v = first + std::size_t(r);
    m_buffer.positions[v] = vec_cast<float>(p);
  }
}

void Ridge::paint() {
  for (std::size_t v = 0; v < m_buffer.paint.size(); ++v) {
    const Station& st = m_stations[v / kRidgeRows % m_stations.size()];
    const double t = share_down(int(v % kRidgeRows));
    // The tint is the ligament's colour, which is near to that of the fat below a wall's peritoneum.
    const double own = (1 - 0.45 * smooth(0.5, 1, st.over)) * smooth(0.5 - 0.15 * st.over, 0, t) *
                       (st.beyond ? 0.5 : 1.0) * (m_covered ? 0.6 : 1.0);
    const double fat = fat_below(vec_cast<double>(m_buffer.positions[v]));
    m_buffer.paint[v].openness = to_byte(0.78 + 0.22 * std::fabs(1 - 2 * t));
    m_buffer.paint[v].tint = to_byte(std::max(own, 0.6 * fat * smooth(0, 0.5, t)));
  }
}

/// Where heat has left its mark on the ligament, what covers it has it, too.
void Ridge::burn(const sim::State& state) {
  for (std::size_t i = 0; i < m_stations.size(); ++i) {
    const Station& st = m_stations[i];
    if (st.beyond) continue;
    std::uint8_t most = 0;
    for (int k = 0; k < 8; ++k) {
      const double a = 0.785398163397448 * k, r = 0.8 * st.radius;
      most = std::max(most, m_marks.burn_at(state, {st.s, r * std::cos(a), r * std::sin(a)}));
    }
    for (const std::size_t flank : {0u, 1u})
      for (std::size_t r = 0; r < kRidgeRows; ++r)
        m_buffer.paint[(flank * m_stations.size() + i) * kRidgeRows + r].burn =
            to_byte(st.over * most / 255.0 * smooth(0.5, 0.2, double(r) / kRidgeRows));
  }
}

void Ridge::update(const sim::State& state) {
  const tissue::StrandState& now = state.strands[std::size_t(m_strand)];
  std::vector<StrandPiece> pieces =
      pieces_of(*m_body, now.alive, {state.cuts.data(), std::size_t(state.cut_count)}, m_strand);
  const bool burnt = m_marks.stirred(state), cut = pieces != m_pieces;
  if (!m_moved(now.x) && !burnt && !cut) return;
  m_pieces = std::move(pieces);
  place(StrandCurve(*m_body, now, m_pieces));
  if (burnt) {
    burn(state);
    m_mesh.update(m_buffer);
  } else {
    m_mesh.move(m_buffer.positions, m_buffer.normals);
  }
}

}  // namespace trocar::view
