#include <algorithm>
#include <array>
#include <cmath>

#include <trocar/interactions/instrument/lever.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/view/analysis/force_arrows.hpp>

namespace trocar::view {
namespace {

constexpr std::uint32_t kArrowAround = 10;
constexpr double kArrowThick = 0.0007, kHeadThick = 0.0018,
                 kHeadLong = 0.0045;  // [m] radii, length of a full-grown arrow

void add_grip(const sim::Model& model, const sim::State& state, int hand, std::vector<ForceArrow>& to) {
  const interactions::ToolState& tool = state.tools[std::size_t(hand)];
  if (tool.holds == 0) return;
  const interactions::ToolShape shape = sim::shape_of(model, state, std::size_t(hand));
  ForceArrow grip{ForceKind::grip, {}, {}, hand};
  for (int i = 0; i < tool.holds; ++i) {
    const interactions::Hold& h = tool.hold[i];
    grip.at += from_jaw(shape, {h.local[0], h.local[1], h.local[2]}) / double(tool.holds);
    grip.force += Vec3d{h.force[0], h.force[1], h.force[2]};
  }
  to.push_back(grip);
}

void add_touches(const sim::Model& model, const sim::State& state, int hand, std::vector<ForceArrow>& to) {
  const interactions::ToolShape shape = sim::shape_of(model, state, std::size_t(hand));
  const interactions::TouchBook& book = state.touches[std::size_t(hand)];
  for (int i = 0; i < book.count; ++i)
    if (book.touch[i].anchored)
      to.push_back({ForceKind::touch, place_of(shape, book.touch[i]), press_of(book.touch[i]), hand});
}

/// Axes of an arrow: across it, beside that, along it.
struct Stick {
  std::array<Vec3d, 3> axes;
  render::Paint paint;
};

/// @param lean  of the normals, along the arrow: 0 a rod's, far below it its back's
void ring(MeshBuffer& b, const Stick& stick, Vec3d at, double radius, double lean) {
  for (std::uint32_t k = 0; k < kArrowAround; ++k) {
    const double angle = 2 * portable::pi * k / kArrowAround;
    const Vec3d out = std::cos(angle) * stick.axes[0] + std::sin(angle) * stick.axes[1];
    b.add(vec_cast<float>(at + radius * out), stick.paint);
    b.normals.push_back(vec_cast<float>(normalised(out + lean * stick.axes[2], out)));
  }
}

/// A rod, a cone, and the faces at their backs.
void add_arrow(Vec3d tail, Vec3d tip, render::Paint paint, MeshBuffer& b) {
  const double size = length(tip - tail);
  const Vec3d along = normalised(tip - tail, Vec3d{0, 0, 1}), across = any_perpendicular(along);
  const Stick stick{{across, cross(along, across), along}, paint};
  const double grown = std::min(1.0, size / (2 * kHeadLong));  // short ones are slim ones
  const Vec3d neck = tip - std::min(kHeadLong * grown, 0.6 * size) * along;
  const std::uint32_t first = b.size();
  constexpr double kBack = -1000, kCone = 0.4;
  ring(b, stick, tail, 0, kBack);
  ring(b, stick, tail, kArrowThick * grown, 0);
  ring(b, stick, neck, kArrowThick * grown, 0);
  ring(b, stick, neck, kArrowThick * grown, kBack);
  ring(b, stick, neck, kHeadThick * grown, kBack);
  ring(b, stick, neck, kHeadThick * grown, kCone);
  ring(b, stick, tip, 0, kCone);
  for (std::uint32_t k = 0; k + 1 < 7; ++k)
    join_rows(b, first + k * kArrowAround, first + (k + 1) * kArrowAround, kArrowAround, true);
}

}  // namespace

std::vector<ForceArrow> forces_of(const sim::Model& model, const sim::State& state) {
  std::vector<ForceArrow> all;
  for (int h = 0; h < int(model.hands.size()); ++h) {
    add_grip(model, state, h, all);
    add_touches(model, state, h, all);
    const auto hand = std::size_t(h);
    const Vec3d on_wall = load_at_trocar(model.tool(state, hand), state.tools[hand], state.touches[hand]).on_wall;
    all.push_back({ForceKind::trocar, sim::port_of(model, state, hand), on_wall, h});
  }
  std::erase_if(all, [](const ForceArrow& a) { return !(length(a.force) >= kLeastForce); });
  return all;
}

std::array<Vec3d, 2> ends_of(const ForceArrow& arrow, double metres_per_newton) {
  const double force = length(arrow.force);
  const Vec3d way = std::min(metres_per_newton, kLongestArrow / std::max(force, 1e-9)) * arrow.force;
  if (arrow.kind == ForceKind::touch) return {arrow.at - way, arrow.at};
  return {arrow.at, arrow.at + way};
}

void ForceArrows::update(const std::vector<ForceArrow>& arrows, const AnalysisOptions& o, render::Backend& backend) {
  MeshBuffer& b = m_mesh.buffer;
  b.positions.clear(), b.normals.clear(), b.paint.clear(), b.indices.clear(), m_mesh.value.clear();
  for (const ForceArrow& arrow : arrows) {
    const auto [tail, tip] = ends_of(arrow, o.force_length);
    add_arrow(tail, tip, paint_shown_as(colour_of(arrow.kind)), b);
    m_mesh.value.resize(b.size(), float(length(arrow.force)));
  }
  m_mesh.show(backend, true);
}

}  // namespace trocar::view
