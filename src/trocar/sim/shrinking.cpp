#include <algorithm>
#include <array>

#include <trocar/sim/current_cut.hpp>
#include <trocar/sim/shrinking.hpp>
#include <trocar/sim/stage.hpp>
#include <trocar/tissue/heat_look.hpp>

namespace trocar::sim {
namespace {

using interactions::ElectrodeTouch, interactions::kMembraneBase, interactions::kSolidBase;

constexpr double kAround = 0.008;    // [m] from an electrode to the middle of springs that it may shrink
constexpr float kTold = 0.005f;      // a spring that shrinks less stays as it is
constexpr std::uint64_t kEvery = 8;  // steps of the heat between two looks at a lattice or a fold
constexpr std::array kAlong{0.1, 0.3, 0.5, 0.7, 0.9};

/// A body of springs, and its State; null where it is none or can be cut.
struct Springs {
  const tissue::NetworkModel* model = nullptr;
  const tissue::NetworkState* state = nullptr;
};
Springs springs_of(const StepContext& c, std::int32_t body) noexcept {
  if (body >= kMembraneBase) {
    const size_t i = size_t(body - kMembraneBase);
    return {&c.model.membranes[i].sheet.network, &c.state.membranes[i].network};
  }
  const size_t i = size_t(body - kSolidBase);
  if (i >= c.model.solids.size()) return {};
  return {&c.model.solids[i].network, &c.state.solids[i]};
}

float shrunk_at(const StepContext& c, std::int32_t body, Vec3d at) noexcept {
  return tissue::shrinkage(tissue::reading(c.model.energy.heat, c.state.heat, body, at));
}

/// The entry of that spring, or a new one; null where there is no room.
ShrunkSpring* entry_of(StepContext& c, std::int32_t body, std::int32_t spring) noexcept {
  const auto end = c.state.shrunk.begin() + c.state.shrunk_count;
  const auto found = std::find_if(c.state.shrunk.begin(), end, [body, spring](const ShrunkSpring& s) {
    return s.body == body && s.spring == spring;
  });
  if (found != end) return &*found;
  if (c.state.shrunk_count == kMaxShrunk) {
    c.report.flags |= StepReport::kHeatFull;
    return nullptr;
  }
  c.state.shrunk[size_t(c.state.shrunk_count++)] = {body, spring, 1};
  return &*end;
}

void shrink_springs(StepContext& c, std::int32_t body, Vec3d electrode) noexcept {
  const tissue::NetworkModel* m = springs_of(c, body).model;
  if (!m) return;
  for (int s = 0; s < m->springs; ++s) {
    const Vec3d a = m->rest[size_t(m->spring_nodes[size_t(2 * s)])];
    const Vec3d b = m->rest[size_t(m->spring_nodes[size_t(2 * s + 1)])], off = 0.5 * (a + b) - electrode;
    if (dot(off, off) > kAround * kAround) continue;
    float share = 0;
    for (const double w : kAlong) share += shrunk_at(c, body, a + w * (b - a)) / float(kAlong.size());
    if (share > 1 - kTold) continue;
    if (ShrunkSpring* entry = entry_of(c, body, s)) entry->share = std::min(entry->share, share);
  }
}

void shrink_strand(StepContext& c, const ElectrodeTouch& touch) noexcept {
  const std::int32_t strand = touch.contact.body;
  const Section section = section_of(c, strand, touch.point.element, touch.contact.a.x);
  double sum = double(shrunk_at(c, strand, section.middle));
  for (const Vec3d p : section.around) sum += double(shrunk_at(c, strand, p));
  double& share = c.state.strands[size_t(strand)].shrunk[size_t(touch.point.element)];
  share = std::min(share, sum / 5);
}

}  // namespace

void shrink_tissue(StepContext& c, const ElectrodeTouch& touch) noexcept {
  if (touch.contact.body < kSolidBase) return shrink_strand(c, touch);
  if (c.state.heat.tick / std::uint64_t(c.model.energy.heat.period) % kEvery != 0) return;
  shrink_springs(c, touch.contact.body, 0.5 * (touch.contact.a + touch.contact.b));
}

void draw_together(StepContext& c) noexcept {
  for (int i = 0; i < c.state.shrunk_count; ++i) {
    const ShrunkSpring& s = c.state.shrunk[size_t(i)];
    const Springs body = springs_of(c, s.body);
    const float whole = tissue::spring_scale(*body.model, *body.state, s.spring);
    if (!(whole > 0)) continue;
    interactions::NetworkLoads& loads = s.body >= kMembraneBase ? c.work.membrane_loads[size_t(s.body - kMembraneBase)]
                                                                : c.work.organ_loads[size_t(s.body - kSolidBase)];
    const int end[2] = {body.model->spring_nodes[size_t(2 * s.spring)],
                        body.model->spring_nodes[size_t(2 * s.spring + 1)]};
    for (size_t k = 0; k < 2; ++k) {
      tissue::NodeLoad load;
      load.node = end[k];
      load.k = whole * float(tissue::spring_stiffness(*body.model, s.spring)) * (1 / s.share - 1);
      load.x0 = vec_cast<float>(position(*body.model, *body.state, end[1 - k]));
      loads.add(load, {interactions::Owner::body, 0, 0});
    }
  }
}

}  // namespace trocar::sim
