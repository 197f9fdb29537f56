#include <algorithm>
#include <cmath>

#include <trocar/interactions/verbs/pierce.hpp>

namespace trocar::interactions {
namespace {

constexpr double kDeepest = 0.025;   // [m] below a skin that is looked for
constexpr double kAlongside = -0.1;  // cosine of the needle with the skin's normal
constexpr double kLeastCarried = 0.01;

/// The skin about a place that carries what a needle does there: no more than kMostCarry vertices, their shares add up
/// to 1.
class Patch {
 public:
  Patch(const tissue::Skin& skin, const SkinPoint& place) noexcept : m_skin(skin) {
    for (std::size_t k = 0; k < 3; ++k)
      m_middle += place.weights[int(k)] * vec_cast<double>(skin.rest[std::size_t(place.vertex[k])]);
    for (const std::int32_t v : place.vertex) {
      take(v);
      for (int i = skin.neighbour_first[std::size_t(v)]; i < skin.neighbour_first[std::size_t(v) + 1]; ++i)
        take(skin.neighbour[std::size_t(i)]);
    }
    if (m_sum > 0) return;
    for (std::size_t k = 0; k < 3; ++k) add(place.vertex[k], place.weights[int(k)]);  // a coarse skin: its triangle
  }
  template <class F>
  void each(F&& f) const noexcept {
    for (std::size_t i = 0; i < m_count; ++i) f(m_vertex[i], m_share[i] / m_sum);
  }

 private:
  static constexpr std::size_t kMostCarry = 48;

  void take(int vertex) noexcept {
    const Vec3d off = vec_cast<double>(m_skin.rest[std::size_t(vertex)]) - m_middle;
    const double inside = 1 - dot(off, off) / (kCarriedOver * kCarriedOver);
    if (inside <= 0 || std::find(m_vertex.begin(), m_vertex.begin() + m_count, vertex) != m_vertex.begin() + m_count)
      return;
    add(vertex, inside * inside);
  }
  void add(int vertex, double share) noexcept {
    if (m_count == kMostCarry) return;
    m_vertex[m_count] = vertex;
    m_share[m_count++] = share;
    m_sum += share;
  }

  const tissue::Skin& m_skin;
  Vec3d m_middle;
  std::array<int, kMostCarry> m_vertex{};
  std::array<double, kMostCarry> m_share{};
  std::size_t m_count = 0;
  double m_sum = 0;
};

void load_about(const Bodies& bodies, const MaterialPoint& point, const SkinLoad& whole, std::int32_t hand) noexcept {
  const std::size_t organ = point.body.index();
  const Surface& surface = bodies.organ(organ);
  Patch(*surface.skin, skin_at(bodies, point)).each([&](int vertex, double share) {
    if (share < kLeastCarried) return;
    SkinLoad load = whole;
    load.k *= share;
    load.d *= share;
    add_skin_load(surface.nodes, *surface.skin, vertex, load, {Owner::tool_contact, hand, 0},
                  bodies.work->organs[organ].loads);
  });
}

}  // namespace

NeedleLine needle_of(const ToolModel& tool, const ToolShape& shape) noexcept {
  NeedleLine line;
  line.axis = shape.frame.axis();
  line.base = shape.frame.tip;
  line.out = tool.needle.length - shape.needle_in;
  line.point = line.base + line.out * line.axis;
  return line;
}

SkinPoint skin_at(const Bodies& bodies, const MaterialPoint& point) noexcept {
  const Surface& surface = bodies.organ(point.body.index());
  const Vec3d place = place_of(bodies, point);
  const int near = nearest_vertex_near(surface, place, kPointFound);
  return nearest_skin_point(surface, near >= 0 ? near : nearest_vertex(surface, place), place);
}

MaterialPoint caught_at(const Bodies& bodies, std::size_t organ, const NeedleLine& needle) noexcept {
  const Surface& surface = bodies.organ(organ);
  const Vec3d p = needle.point;
  if (!surface.pose->bounds.reaches(p, kPointFound)) return {};
  const int vertex = nearest_vertex_near(surface, p, kPointFound);
  if (vertex < 0) return {};
  const SkinPoint on = nearest_skin_point(surface, vertex, p);
  // From within an organ's far side, or alongside its skin, a point does not catch.
  if (dot(on.point - p, on.normal) <= 0 || dot(needle.axis, on.normal) > kAlongside) return {};
  return at_vertex(bodies, organ, vertex, on.point);
}

double sunk_into(const Bodies& bodies, const MaterialPoint& point, const NeedleLine& needle) noexcept {
  const Vec3d beyond = needle.point - place_of(bodies, point);
  const double sunk = dot(beyond, needle.axis);
  // It has been drawn back, or the skin has turned away from it.
  if (sunk <= 0 || length(beyond) > kPointFound || dot(needle.axis, skin_at(bodies, point).normal) > kAlongside)
    return 0;
  return sunk;
}

double press_skin(const Bodies& bodies, const MaterialPoint& point, const NeedleLine& needle,
                  std::int32_t hand) noexcept {
  SkinLoad load;
  load.k = kPointStiffness;
  load.shift = needle.point - place_of(bodies, point);
  load_about(bodies, point, load, hand);
  return kPointStiffness * dot(load.shift, needle.axis);
}

void carry_skin(const Bodies& bodies, const MaterialPoint& point, const NeedleLine& needle, double& anchor,
                std::int32_t hand) noexcept {
  const Vec3d at = place_of(bodies, point);
  const double depth = dot(needle.point - at, needle.axis);
  const double slack = kNeedleDrag * std::max(0.0, depth) / kShaftStiffness;
  anchor = std::clamp(anchor, depth - slack, depth + slack);
  SkinLoad load;
  load.k = kShaftStiffness;
  load.shift = (needle.point - anchor * needle.axis) - at;
  load_about(bodies, point, load, hand);
}

double depth_below(const Surface& surface, Vec3d place) noexcept {
  const int vertex = nearest_vertex_near(surface, place, kDeepest);
  if (vertex < 0) return kDeepest;
  const SkinPoint on = nearest_skin_point(surface, vertex, place);
  const double off = length(place - on.point);
  return dot(on.point - place, on.normal) >= 0 ? off : -off;
}

}  // namespace trocar::interactions
