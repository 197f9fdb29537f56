#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <trocar/numerics/portable.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/view/anatomy/liver_shape.hpp>
#include <trocar/view/base/fair_surface.hpp>
#include <trocar/view/base/relief.hpp>

namespace trocar::view {
namespace {

constexpr double kLiverStep = 0.003;  // [m] between columns and rows
constexpr int kLiverRows = 56;        // from the edge towards the head
constexpr double kBeside = 0.06;      // [m] beyond the body to either side
constexpr double kInset = 0.009;      // [m] of the body's ends, which are round: there the dome goes straight on
constexpr double kLiverTip = 0.002;   // [m] of them: nothing is to be seen there
constexpr double kDroops = 0.012;     // [m] beyond the body's ends its margin begins to sink
constexpr double kFalls = -0.27;      // slope of the body's upper side from which on the dome takes over
constexpr int kEvenJoin = 30;         // passes over the line where it does
constexpr double kLiverLoose = 8e-6, kFirm = 6e-4;          // weights, see fairest()
constexpr double kLiverSunk = 0.00022;                      // [m] times (rings into the body)^2
constexpr double kBehindWall = 0.003;                       // [m]
constexpr int kLiverOverlap = 3;                            // rings
constexpr double kLiverTucked = 0.0032, kTuckedTo = 0.012;  // [m] the ends of its margin into the body, up to there
constexpr double kNoHeight = std::numeric_limits<double>::quiet_NaN();

/// [m] from the edge to a row; the first ones lie close, as the margin is round.
double offset_of(int row) { return row < 3 ? kLiverStep * row * row / 6.0 : kLiverStep * (row - 1.5); }

/// What a big organ is like, over the line where the dome begins: higher to the right (-x), lower to the left, and
/// rolling over below the diaphragm.
double wished(double beside, double up) {
  const double lobes = 0.022 * smooth(0, -0.09, beside) - 0.012 * smooth(0.02, 0.1, beside);
  const double over = std::max(0.0, up - 0.045);
  return lobes + 0.03 * up - over * over / 0.075;
}

/// Leaves what lies before the wall, cut along it.
void cut_at_wall(MeshBuffer& b, const WallSurface& wall) {
  std::vector<float> before;
  for (const Vec3f& f : b.positions) {
    const WallSurface::Place place = wall.nearest(vec_cast<double>(f));
    before.push_back(place.there ? float(dot(vec_cast<double>(f) - place.point, place.normal) + kBehindWall) : 1.0f);
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> cuts;
  const auto cut = [&](std::uint32_t i, std::uint32_t j) {
    const auto [found, anew] = cuts.try_emplace(std::minmax(i, j), b.size());
    const float t = before[i] / (before[i] - before[j]);
    if (anew) b.add(b.positions[i] + t * (b.positions[j] - b.positions[i]));
    return found->second;
  };
  const std::vector<std::uint32_t> whole = std::exchange(b.indices, {});
  for (std::size_t t = 0; t + 2 < whole.size(); t += 3) {
    std::vector<std::uint32_t> left;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t i = whole[t + k], j = whole[t + (k + 1) % 3];
      if (before[i] > 0) left.push_back(i);
      if ((before[i] > 0) != (before[j] > 0)) left.push_back(cut(i, j));
    }
    for (std::size_t k = 2; k < left.size(); ++k) b.triangle(left[0], left[k - 1], left[k]);
  }
}

}  // namespace

LiverShape::LiverShape(std::span<const Vec3f> points, std::span<const std::uint32_t> triangles) {
  scan(points, triangles);
  find_join();
  fair();
}

double LiverShape::y_of(std::size_t column, int row) const { return m_columns[column].low + offset_of(row); }

/// Upper side of the body, and its edge, which continues beyond its ends.
void LiverShape::scan(std::span<const Vec3f> points, std::span<const std::uint32_t> triangles) {
  double from = 1e9, to = -1e9;
  for (const std::uint32_t v : triangles) {
    from = std::min(from, double(points[v].x));
    to = std::max(to, double(points[v].x));
  }
  for (double x = from - kBeside; x < to + kBeside; x += kLiverStep) m_columns.push_back({x, 1e9, 0, 0});
  m_z.assign(m_columns.size() * std::size_t(kLiverRows), kNoHeight);
  std::size_t begin = 0, end = 0;  // columns that meet the body at all
  for (std::size_t i = 0; i < m_columns.size(); ++i) {
    const double x = m_columns[i].x;
    if (x > from + kLiverTip && begin == 0) begin = i;
    if (x < to - kLiverTip) end = i;
    if (x > from + kInset && m_first == 0) m_first = i;
    if (x < to - kInset) m_last = i;
  }
  std::vector<double> count(m_columns.size(), 0.0);
  const auto each_near = [&](double reach, auto&& take) {
    for (const std::uint32_t v : triangles) {
      const Vec3d p = vec_cast<double>(points[v]);
      for (std::size_t i = begin; i <= end; ++i)
        if (std::fabs(p.x - m_columns[i].x) < reach) take(m_columns[i], count[i], p);
    }
  };
  each_near(0.004, [](Column& c, double&, Vec3d p) { c.low = std::min(c.low, p.y); });
  each_near(0.004, [](Column& c, double& n, Vec3d p) {
    if (p.y > c.low + 0.003) return;
    c.edge += p.z;
    n += 1;
  });
  for (std::size_t i = begin; i <= end; ++i) m_columns[i].edge /= std::max(1.0, count[i]);
  for (int pass = 0; pass < 6; ++pass)
    for (std::size_t i = begin + 1; i < end; ++i) {
      m_columns[i].low = 0.5 * m_columns[i].low + 0.25 * (m_columns[i - 1].low + m_columns[i + 1].low);
      m_columns[i].edge = 0.5 * m_columns[i].edge + 0.25 * (m_columns[i - 1].edge + m_columns[i + 1].edge);
    }
  const auto lead_on = [&](std::size_t from_column, std::size_t inner, std::size_t i) {
    const Column &e = m_columns[from_column], &before = m_columns[inner];
    const double d = std::fabs(m_columns[i].x - e.x);
    const double slope = std::clamp((e.low - before.low) / std::fabs(e.x - before.x), -0.7, 0.7);
    m_columns[i].low =
        e.low + slope * d * std::exp(-d / 0.022) + 0.0015 * waves({m_columns[i].x, 0.3, 0}, 0.03) * smooth(0, 0.02, d);
    const double past = std::max(0.0, d - kDroops);
    m_columns[i].low += 1.1 * past * past / (0.02 + past);  // and turns towards the head
    m_columns[i].edge = e.edge;
  };
  for (std::size_t i = 0; i < begin; ++i) lead_on(begin, begin + 4, i);
  for (std::size_t i = end + 1; i < m_columns.size(); ++i) lead_on(end, end - 4, i);
  for (std::size_t i = 0; i < m_columns.size(); ++i)  // around the body's ends, not inside them
    m_columns[i].low -= 0.0012 * (i < m_first  ? smooth(m_columns[m_first].x, m_columns[begin].x, m_columns[i].x)
                                  : i > m_last ? smooth(m_columns[m_last].x, m_columns[end].x, m_columns[i].x)
                                               : 0);
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {  // the upper side: the highest triangle over a point
    const Vec3d a = vec_cast<double>(points[triangles[t]]), b = vec_cast<double>(points[triangles[t + 1]]),
                c = vec_cast<double>(points[triangles[t + 2]]);
    const double twice = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (!(twice > 1e-12)) continue;
    for (std::size_t i = m_first; i <= m_last; ++i) {
      const double x = m_columns[i].x;
      if (x < std::min({a.x, b.x, c.x}) || x > std::max({a.x, b.x, c.x})) continue;
      for (int k = 0; k < kLiverRows; ++k) {
        const double y = y_of(i, k);
        const double u = ((b.x - x) * (c.y - y) - (b.y - y) * (c.x - x)) / twice;
        const double v = ((c.x - x) * (a.y - y) - (c.y - y) * (a.x - x)) / twice;
        if (u < 0 || v < 0 || u + v > 1) continue;
        double& z = m_z[at(i, k)];
        const double here = u * a.z + v * b.z + (1 - u - v) * c.z;
        z = std::isnan(z) ? here : std::max(z, here);
      }
    }
  }
}

/// Where the dome begins on the body.
void LiverShape::find_join() {
  std::vector<double> join(m_columns.size(), 0.0);
  for (std::size_t i = m_first; i <= m_last; ++i) {
    int k = 4;
    while (k + 3 < kLiverRows && !std::isnan(m_z[at(i, k + 2)]) &&
           (m_z[at(i, k + 2)] - m_z[at(i, k)]) > kFalls * (offset_of(k + 2) - offset_of(k)))
      ++k;
    join[i] = k;
  }
  for (int pass = 0; pass < kEvenJoin; ++pass)
    for (std::size_t i = m_first + 1; i < m_last; ++i) join[i] = 0.5 * join[i] + 0.25 * (join[i - 1] + join[i + 1]);
  for (std::size_t i = m_first; i <= m_last; ++i) m_columns[i].join = int(join[i]);
}

/// Rings into what is the body's own, 0 outside.
std::vector<int> LiverShape::depths() const {
  std::vector<int> depth(m_z.size(), 0);
  for (std::size_t i = m_first; i <= m_last; ++i)
    for (int k = 0; k < m_columns[i].join; ++k)
      depth[at(i, k)] = std::min({m_columns[i].join - k, int(i - m_first) + 1, int(m_last - i) + 1});
  return depth;
}

void LiverShape::fair() {
  const std::size_t n = m_columns.size();
  std::vector<std::vector<int>> net(m_z.size());
  std::vector<double> wish(m_z.size()), weight(m_z.size());
  double middle = 0, begins = 0, level = 0, count = 0;
  for (std::size_t i = m_first; i <= m_last; ++i) {
    const int k = std::max(0, m_columns[i].join - 1);
    if (std::isnan(m_z[at(i, k)])) continue;
    middle += m_columns[i].x, begins += y_of(i, k), level += m_z[at(i, k)], count += 1;
  }
  count = std::max(count, 1.0);
  middle /= count, begins /= count, level /= count;
  const double half = 0.5 * (m_columns[m_last].x - m_columns[m_first].x);
  for (std::size_t i = 0; i < n; ++i)
    for (int k = 0; k < kLiverRows; ++k) {
      const std::size_t p = at(i, k);
      const auto join = [&](std::size_t a, int b) { net[p].push_back(int(at(a, b))); };
      if (i > 0) join(i - 1, k);
      if (i + 1 < n) join(i + 1, k);
      if (k > 0) join(i, k - 1);
      if (k + 1 < kLiverRows) join(i, k + 1);
      const Column& c = m_columns[i];
      wish[p] = level + wished(c.x - middle, y_of(i, k) - begins);
      const double aside = std::max(0.0, std::fabs(c.x - middle) - half);
      const double ahead = c.join > 0 ? offset_of(k) - offset_of(c.join) : 1.0;
      const double away = std::min(std::max(aside, ahead), std::hypot(aside, std::max(0.0, y_of(i, k) - begins)));
      weight[p] = kLiverLoose + kFirm * smooth(0.015, 0.07, away);
      if (k < c.join && !std::isnan(m_z[p])) {
        wish[p] = m_z[p];
        weight[p] = kHeldFast;
        continue;
      }
      if (c.join > 0) continue;
      // Beside the body its margin continues as it is at its end.
      const std::size_t end = i < m_first ? m_first : m_last;
      const std::size_t inner = i < m_first ? m_first + 2 : m_last - 2;
      const double d = std::fabs(c.x - m_columns[end].x);
      const double falls = (m_z[at(end, k)] - m_z[at(inner, k)]) / (2 * kLiverStep);
      const double profile = m_z[at(end, k)] + std::clamp(falls, -0.4, 0.4) * d * std::exp(-d / 0.012);
      const double past = std::max(0.0, d - kDroops), droop = 0.6 * past * past / (0.02 + past);
      wish[p] -= droop * smooth(0.09, 0.02, offset_of(k));  // its ends sink into what is around, no point stands out
      if (k >= m_columns[end].join || std::isnan(profile)) continue;
      const double close = smooth(0.03, 0.004, offset_of(k));
      const double capped = smooth(0.02, 0.009, d);  // it goes over the body's rounded end
      wish[p] = profile - droop + (1 - capped) * 0.35 * (wish[p] - profile) * smooth(0.012, 0.04, offset_of(k)) +
                0.0004 * capped;
      weight[p] = std::max(weight[p], 0.02 * std::max(close * close, capped));
    }
  m_z = fairest(net, wish, weight);
}

double LiverShape::height(double x, double y) const {
  const double i = std::clamp((x - m_columns.front().x) / kLiverStep, 0.0, double(m_columns.size()) - 1.001);
  const auto c = std::size_t(i);
  const auto in_column = [&](std::size_t column) {
    int k = 0;
    while (k + 2 < kLiverRows && y_of(column, k + 1) < y) ++k;
    const double t = std::clamp((y - y_of(column, k)) / (y_of(column, k + 1) - y_of(column, k)), 0.0, 1.0);
    return m_z[at(column, k)] + t * (m_z[at(column, k + 1)] - m_z[at(column, k)]);
  };
  const double t = i - double(c);
  return (1 - t) * in_column(c) + t * in_column(c + 1);
}

MeshBuffer LiverShape::dome(const WallSurface& wall) const {
  MeshBuffer b;
  const std::vector<int> depth = depths();
  const std::size_t n = m_columns.size();
  const auto within_body = [&](std::size_t i) {
    return smooth(kLiverStep, -kLiverStep,
                  std::max(m_columns[m_first].x - m_columns[i].x, m_columns[i].x - m_columns[m_last].x));
  };
  for (std::size_t i = 0; i < n; ++i)
    for (int k = 0; k < kLiverRows; ++k) {
      const double x = m_columns[i].x, y = y_of(i, k);
      const double own = std::min(depth[at(i, k)], kLiverOverlap + 1);
      const double beyond = m_columns[i].join > 0
                                ? y - y_of(i, m_columns[i].join)
                                : std::min(offset_of(k), std::fabs(x - m_columns[i < m_first ? m_first : m_last].x));
      const double uneven = 0.0006 * waves({x, y, m_z[at(i, k)]}, 0.024) * smooth(0.002, 0.02, beyond);
      const double tucked = kLiverTucked * within_body(i) * smooth(kTuckedTo, 0, offset_of(k));
      b.add(vec_cast<float>(Vec3d{x, y + tucked, m_z[at(i, k)] + uneven - kLiverSunk * own * own}));
    }
  const auto v = [&](std::size_t i, int k) { return std::uint32_t(at(i, k)); };
  for (std::size_t i = 0; i + 1 < n; ++i)
    for (int k = 0; k + 1 < kLiverRows; ++k) {
      const int least = std::min({depth[at(i, k)], depth[at(i + 1, k)], depth[at(i, k + 1)], depth[at(i + 1, k + 1)]});
      if (least < kLiverOverlap) b.quad(v(i, k), v(i + 1, k), v(i + 1, k + 1), v(i, k + 1));
    }
  // The lower side of the margin, beside the body.
  constexpr int kBelow = 6;
  const auto below = [&](std::size_t first, std::size_t last) {
    const std::uint32_t begin = b.size();
    for (std::size_t i = first; i <= last; ++i)
      for (int k = 1; k <= kBelow; ++k) {
        const double off = offset_of(2 * k), thick = 0.0105 * std::sqrt(std::min(1.0, off / 0.03));
        b.add(vec_cast<float>(
            Vec3d{m_columns[i].x, m_columns[i].low + off + kLiverTucked * within_body(i), m_z[at(i, 0)] - thick}));
      }
    const auto low = [&](std::size_t i, int k) {
      return k == 0 ? v(i, 0) : begin + std::uint32_t(i - first) * kBelow + std::uint32_t(k - 1);
    };
    for (std::size_t i = first; i < last; ++i)
      for (int k = 0; k < kBelow; ++k) b.quad(low(i, k), low(i, k + 1), low(i + 1, k + 1), low(i + 1, k));
  };
  below(0, m_first + 1);
  below(m_last - 1, n - 1);
  cut_at_wall(b, wall);
  render::vertex_normals(b.positions, b.indices, b.normals);
  return b;
}

/// How far it is from there along the dome until that reaches the wall [m].
double LiverShape::up_to_the_wall(std::size_t column, double begins, const WallSurface& wall) const {
  double y = begins + 0.01;
  for (; y < y_of(column, kLiverRows - 1); y += kLiverStep) {
    const Vec3d p{m_columns[column].x, y, height(m_columns[column].x, y)};
    const WallSurface::Place place = wall.nearest(p);
    if (place.there && dot(p - place.point, place.normal) < 0.001) break;
  }
  return y - begins;
}

MeshBuffer LiverShape::falciform(const WallSurface& wall) const {
  constexpr int kAlong = 40, kUp = 20, kRound = 12, kOn = 10, kSofter = 6;
  const std::size_t column = m_first + (m_last - m_first) / 5;
  const double low = y_of(column, 0), begins = low + 0.003;
  const double reach = up_to_the_wall(column, begins, wall);
  MeshBuffer b;
  for (int i = 0; i <= kAlong; ++i)
    for (int k = 0; k <= kUp; ++k) {
      const double s = double(i) / kAlong, t = double(k) / kUp;
      const double y = begins + reach * s, x = m_columns[column].x + 0.004 * waves({0, y, 0}, 0.06);
      const Vec3d foot{x, y, height(x, y) - 0.0012};
      const WallSurface::Place hung = wall.nearest({x + 0.006, y - 0.016 * (1 - s), foot.z + 0.09});
      const Vec3d top = hung.there ? hung.point - 0.0012 * hung.normal : foot + Vec3d{0, 0, 0.06};
      Vec3d p = foot + t * (top - foot);
      const double slack = 4 * t * (1 - t);
      p.y += 0.02 * slack * (1 - s);  // its border hangs in a bow
      p.z = std::max(p.z, height(p.x, p.y) - 0.004);
      p.x += 0.005 * slack * waves({p.x, p.y, p.z}, 0.05);
      Paint paint;
      paint.openness = to_byte(smooth(0, 0.13, t));  // it runs out on the liver
      paint.tint = to_byte(0.85 * smooth(0.16, 0.02, s + 0.05 * waves(p, 0.012)) +
                           0.5 * smooth(0.2, 0.9, waves(p, 0.021)) * smooth(0.1, 0, std::min(t, 1 - t)));
      b.add(vec_cast<float>(p), paint);
    }
  for (int i = 0; i < kAlong; ++i)
    join_rows(b, std::uint32_t(i * (kUp + 1)), std::uint32_t((i + 1) * (kUp + 1)), kUp + 1, false);
  render::vertex_normals(b.positions, b.indices, b.normals);
  // The round ligament in its border, with fat around it: it comes out of the cleft below the liver, over the margin.
  std::vector<Vec3d> way;
  const double x = b.positions[0].x, edge = m_columns[column].edge;
  const Vec3d cleft{x, low + 0.009, edge - 0.009}, margin{x, low - 0.0025, edge - 0.003};
  const auto begin = vec_cast<double>(b.positions[1]);
  for (int k = 0; k < kOn; ++k) {
    const double u = double(k) / kOn, v = 1 - u;
    way.push_back((v * v) * cleft + (2 * u * v) * margin + (u * u) * begin);
  }
  for (std::size_t k = 1; k <= std::size_t(kUp); ++k) way.push_back(vec_cast<double>(b.positions[k]));
  for (int pass = 0; pass < kSofter; ++pass)
    for (std::size_t k = 1; k + 1 < way.size(); ++k) way[k] = 0.5 * way[k] + 0.25 * (way[k - 1] + way[k + 1]);
  const std::uint32_t cord = b.size();
  const std::size_t last = way.size() - 1;
  Vec3d beside{1, 0, 0};  // goes along with the line, so that it does not twist
  for (std::size_t here = 0; here <= last; ++here) {
    const Vec3d axis = normalised(way[std::min(here + 1, last)] - way[here > 0 ? here - 1 : 0], Vec3d{0, 0, 1});
    beside = normalised(beside - dot(beside, axis) * axis, any_perpendicular(axis));
    const Vec3d u = beside, w = cross(axis, u), p = way[here];
    const double above = std::max(0.0, double(here) - kOn) / kUp;
    const double below =
        smooth(0.9 * kOn, 0.2 * kOn, double(here));  // round the margin it thins out: no knob hangs there
    const double ends =
        (0.9 + 0.9 * smooth(0.5, 0.0, above)) * (1 - 0.65 * below);  // thickest where it leaves the liver
    for (int r = 0; r < kRound; ++r) {
      const double a = portable::two_pi * r / kRound;
      const Vec3d out = std::cos(a) * u + std::sin(a) * w;
      const double fat = waves(p + 0.004 * out, 0.009);
      const double radius = ends * (0.0015 + 0.0004 * waves(p + 0.01 * out, 0.013) + 0.0004 * fat);
      b.add(vec_cast<float>(p + radius * out), Paint{255, 0, 0, to_byte(0.8 + 0.2 * fat)});
      b.normals.push_back(vec_cast<float>(out));
    }
  }
  for (std::uint32_t k = 0; k < last; ++k) join_rows(b, cord + k * kRound, cord + (k + 1) * kRound, kRound, true);
  return b;
}

}  // namespace trocar::view
