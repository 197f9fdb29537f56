#include <algorithm>
#include <cmath>

#include <trocar/render/mesh_arrays.hpp>
#include <trocar/view/cavity.hpp>
#include <trocar/view/relief.hpp>
#include <trocar/view/ridge.hpp>

namespace trocar::view {
namespace {

constexpr int kRows = 10;           // ligament to wall
constexpr double kStep = 0.0028;    // [m] between stations
constexpr double kFrom = 0.10;      // share of the ligament where the fold below it begins ...
constexpr double kDown = 0.72;      // ... and where it has come down to the wall
constexpr double kWidest = 0.016;   // [m] from below the ligament to a flank's foot
constexpr double kOver = 0.74;      // share of the ligament from where on its flanks close over it ...
constexpr double kClosed = 0.97;    // ... and where they have
constexpr double kTucked = 0.0012;  // [m] the border lies below the wall
constexpr double kAtWall = 0.006;   // [m] nearer than that, down is the wall's normal
constexpr int kBeyond = 7;          // stations in the wall

}  // namespace

Ridge::Ridge(const sim::Model& model, const TubeDrawing& tube, int strand, const WallSurface& walls,
             render::Backend& backend)
    : m_body(&model.bodies[std::size_t(strand)]), m_strand(strand) {
  const tissue::StrandState rest = tissue::rest_state(m_body->model);
  const StrandPiece all{0, m_body->nodes() - 1, 0, m_body->length(), false, false};
  const StrandCurve curve(*m_body, rest, {&all, 1});
  const double length_of = m_body->length();
  const int steps = std::max(6, int((1 - kFrom) * length_of / kStep));
  for (int i = 0; i <= steps; ++i) {
    Station st;
    st.s = length_of * (kFrom + (1 - kFrom) * i / steps);
    const CurveFrame f = curve.at(0, st.s);
    st.at = f.point;
    st.along = f.tangent;
    const auto node = std::size_t(place_at(*m_body, st.s).element);
    const std::vector<double>& outer = model.strands[std::size_t(strand)].outer;
    st.radius = 1.06 * std::max(outer[node], outer[node + 1]);
    m_stations.push_back(st);
  }
  const TubeRoot& root = tube.end_root();
  const Vec3d a = m_stations.back().at, da = root.length * m_stations.back().along, b = root.target,
              db = root.length * root.direction;
  for (int i = 1; i <= kBeyond; ++i) {
    const double t = double(i) / kBeyond, u = 1 - t;
    Station st = m_stations.back();
    st.beyond = true;
    st.narrow = u;
    st.at = (u * u * (1 + 2 * t)) * a + (t * t * (3 - 2 * t)) * b + (u * u * t) * da - (t * t * u) * db;
    st.along = normalised((6 * t * u) * (b - a) + (u * (1 - 3 * t)) * da + (t * (3 * t - 2)) * db, st.along);
    m_stations.push_back(st);
  }
  find_feet(walls);
  for (int i = 0; i < 2 * int(m_stations.size()) * kRows; ++i) m_buffer.add({});
  const auto row = [this](std::size_t flank, std::size_t i) {
    return std::uint32_t((flank * m_stations.size() + i) * kRows);
  };
  for (const std::size_t flank : {0u, 1u})
    for (std::size_t i = 0; i + 1 < m_stations.size(); ++i)
      join_rows(m_buffer, row(flank, flank ? i : i + 1), row(flank, flank ? i + 1 : i), kRows, false);
  place(curve);
  m_buffer.rest = m_buffer.positions;
  m_mesh = OwnedMesh(backend, m_buffer.data());
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
    const Vec3d down = st.beyond ? -below.normal : st.floor - st.at - kAtWall * below.normal;
    st.side = normalised(cross(st.along, normalised(down, -below.normal)), any_perpendicular(st.along));
  }
  for (Station& st : m_stations) {
    st.depth = smooth(kFrom, kDown, st.s / to_wall);
    st.over = smooth(kOver, kClosed, st.s / to_wall);
    st.narrow = std::min(st.narrow, smooth(1.35, 1, st.s / to_wall));
  }
  even_out(4, [](Station& st) -> Vec3d& { return st.side; });
  for (std::size_t i = 0; i < n; ++i) {
    Station& st = m_stations[i];
    st.side = normalised(st.side, any_perpendicular(st.along));
    const double high = std::max(0.0, dot(st.at - st.floor, st.normal[0]));
    const double uneven = 1 + 0.3 * waves(st.floor, 0.021);
    const double wide = (0.2 + 0.8 * st.narrow) * std::min(kWidest, 1.6 * st.radius + 0.002 + 0.5 * high) * uneven;
    for (const int flank : {0, 1}) st.foot[flank] = st.floor + ((flank ? -wide : wide)) * st.side;
  }
  for (const int flank : {0, 1}) {
    even_out(8, [flank](Station& st) -> Vec3d& { return st.foot[flank]; });
    for (Station& st : m_stations) {
      const WallSurface::Place at = walls.nearest(st.foot[flank]);
      st.foot[flank] = at.point;
      st.normal[flank] = at.normal;
    }
  }
}

void Ridge::place(const StrandCurve& curve) {
  const std::span<const StrandPiece> pieces = curve.pieces();
  for (std::size_t i = 0; i < m_stations.size(); ++i) {
    const Station& st = m_stations[i];
    int piece = int(pieces.size()) - 1;
    while (piece > 0 && pieces[std::size_t(piece)].from > st.s) --piece;
    const Vec3d at = st.beyond ? st.at : curve.at(piece, st.s).point;
    for (const int flank : {0, 1}) place_flank(st, at, flank, (std::size_t(flank) * m_stations.size() + i) * kRows);
  }
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
  for (std::size_t i = 0; i < m_stations.size(); ++i)  // no seam: as the wall's, where it is down there
    for (const std::size_t flank : {0u, 1u}) {
      const Vec3f n = vec_cast<float>(m_stations[i].normal[flank]);
      const std::size_t first = (flank * m_stations.size() + i) * kRows;
      const double down = smooth(0.9, 1, m_stations[i].depth);
      for (std::size_t r = kRows - 4; r < kRows; ++r) {
        Vec3f& own = m_buffer.normals[first + r];
        const float w = float(down) * std::min(1.0f, float(r + 5 - kRows) / 3);
        if (dot(own, n) < 0) own = -own;
        own = normalised((1 - w) * own + w * n, n);
      }
    }
}

/// From the ligament's side, below its crest, to the wall.
void Ridge::place_flank(const Station& st, Vec3d at, int flank, std::size_t first) {
  const double sign = flank ? -1 : 1;
  const Vec3d n = st.normal[flank];
  const Vec3d down = normalised(st.floor - at - kAtWall * n, -n), out = sign * st.side;
  const Vec3d away = 0.15 * n - down, up = normalised(away - dot(away, st.along) * st.along, -down);
  const double high = 0.5 + 0.65 * st.over,
               wide = std::sqrt(std::max(0.0, 1 - 0.87 * high * high * (1 - st.over) - st.over));
  const Vec3d top = at + st.radius * ((0.93 * wide) * out + (0.93 * high) * up);
  const Vec3d keel = at + std::max(0.6 * st.radius, st.depth * length(st.floor - at)) * down;
  const double spread = smooth(0.55, 1, st.depth);
  const Vec3d end = keel + spread * (st.foot[flank] - keel);
  const Vec3d level = normalised(out - dot(out, n) * n, out);
  const double reach = length(end - top);
  const Vec3d leaves = reach * normalised((0.49 + 0.5 * st.over) * out + (0.87 - 0.6 * st.over) * down),
              arrives = (0.9 * spread * reach) * level;
  for (int r = 0; r < kRows; ++r) {
    const double t = std::min(1.0, double(r) / (kRows - 2)), u = 1 - t;
    Vec3d p = (u * u * (1 + 2 * t)) * top + (t * t * (3 - 2 * t)) * end + (u * u * t) * leaves - (t * t * u) * arrives;
    if (r == kRows - 1) p = end + spread * (0.002 * level - kTucked * n);
    const std::size_t v = first + std::size_t(r);
    m_buffer.positions[v] = vec_cast<float>(p);
    const double own = 0.35 * smooth(0.4, 0, t), fat = fat_below(p);
    m_buffer.paint[v] = {to_byte(0.75 + 0.25 * std::fabs(1 - 2 * t)), 0, 0,
                         to_byte(std::max(own, fat * smooth(0, 0.5, t)))};
  }
}

void Ridge::update(const sim::State& state) {
  const tissue::StrandState& now = state.strands[std::size_t(m_strand)];
  const std::vector<StrandPiece> pieces =
      pieces_of(*m_body, now.alive, {state.cuts.data(), std::size_t(state.cut_count)}, m_strand);
  place(StrandCurve(*m_body, now, pieces));
  m_mesh.move(m_buffer.positions, m_buffer.normals);
}

}  // namespace trocar::view
