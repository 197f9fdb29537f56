#include <algorithm>
#include <cmath>

#include <trocar/interactions/contact/nearest_skin.hpp>
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
  Patch(const tissue::Skin& skin, const SkinPlace& place) noexcept : m_skin(skin) {
    for (std::size_t k = 0; k < 3; ++k)
      m_middle += place.weight[k] * vec_cast<double>(skin.rest[std::size_t(place.vertex[k])]);
    for (const std::int32_t v : place.vertex) {
      take(v);
      for (int i = skin.neighbour_first[std::size_t(v)]; i < skin.neighbour_first[std::size_t(v) + 1]; ++i)
        take(skin.neighbour[std::size_t(i)]);
    }
    if (m_sum > 0) return;
    for (std::size_t k = 0; k < 3; ++k) add(place.vertex[k], place.weight[k]);  // a coarse skin: its triangle
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

void load_place(const Surface& surface, const SkinPlace& place, const SkinLoad& whole, std::int32_t hand,
                NetworkLoads& loads) noexcept {
  Patch(*surface.skin, place).each([&](int vertex, double share) {
    if (share < kLeastCarried) return;
    SkinLoad load = whole;
    load.k *= share;
    load.d *= share;
    add_skin_load(surface.nodes, *surface.skin, vertex, load, {Owner::tool_contact, hand, 0}, loads);
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

Vec3d place_on(const Surface& surface, const SkinPlace& place) noexcept {
  Vec3d sum;
  for (std::size_t k = 0; k < 3; ++k) sum += place.weight[k] * surface.position(place.vertex[k]);
  return sum;
}

Vec3d normal_on(const Surface& surface, const SkinPlace& place) noexcept {
  Vec3d sum;
  for (std::size_t k = 0; k < 3; ++k) sum += place.weight[k] * surface.normal(place.vertex[k]);
  return normalised(sum, surface.normal(place.vertex[0]));
}

SkinPlace caught_at(const Surface& surface, BodyId body, const NeedleLine& needle) noexcept {
  const Vec3d p = needle.point;
  if (!surface.pose->bounds.reaches(p, kPointFound)) return {};
  const int vertex = nearest_vertex_near(surface, p, kPointFound);
  if (vertex < 0) return {};
  const SkinPoint on = nearest_skin_point(surface, vertex, p);
  // From within an organ's far side, or alongside its skin, a point does not catch.
  if (dot(on.point - p, on.normal) <= 0 || dot(needle.axis, on.normal) > kAlongside) return {};
  SkinPlace place;
  place.body = body;
  for (std::size_t k = 0; k < 3; ++k) {
    place.vertex[k] = on.vertex[k];
    place.weight[k] = on.weights[int(k)];
  }
  return place;
}

double sunk_into(const Surface& surface, const SkinPlace& place, const NeedleLine& needle) noexcept {
  const Vec3d beyond = needle.point - place_on(surface, place);
  const double sunk = dot(beyond, needle.axis);
  // It has been drawn back, or the skin has turned away from it.
  if (sunk <= 0 || length(beyond) > kPointFound || dot(needle.axis, normal_on(surface, place)) > kAlongside) return 0;
  return sunk;
}

double press_skin(const Surface& surface, const SkinPlace& place, const NeedleLine& needle, std::int32_t hand,
                  NetworkLoads& loads) noexcept {
  SkinLoad load;
  load.k = kPointStiffness;
  load.shift = needle.point - place_on(surface, place);
  load_place(surface, place, load, hand, loads);
  return kPointStiffness * dot(load.shift, needle.axis);
}

void carry_skin(const Surface& surface, const SkinPlace& place, const NeedleLine& needle, double& anchor,
                std::int32_t hand, NetworkLoads& loads) noexcept {
  const Vec3d at = place_on(surface, place);
  const double depth = dot(needle.point - at, needle.axis);
  const double slack = kNeedleDrag * std::max(0.0, depth) / kShaftStiffness;
  anchor = std::clamp(anchor, depth - slack, depth + slack);
  SkinLoad load;
  load.k = kShaftStiffness;
  load.shift = (needle.point - anchor * needle.axis) - at;
  load_place(surface, place, load, hand, loads);
}

double depth_below(const Surface& surface, Vec3d place) noexcept {
  const int vertex = nearest_vertex_near(surface, place, kDeepest);
  if (vertex < 0) return kDeepest;
  const SkinPoint on = nearest_skin_point(surface, vertex, place);
  const double off = length(place - on.point);
  return dot(on.point - place, on.normal) >= 0 ? off : -off;
}

}  // namespace trocar::interactions
