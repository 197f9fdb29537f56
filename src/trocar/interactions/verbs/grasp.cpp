#include <algorithm>

#include <trocar/interactions/instrument/tool_contact.hpp>
#include <trocar/interactions/verbs/grasp.hpp>

namespace trocar::interactions {
namespace {

constexpr double kHoldStiffness = 1200;    // [N/m] per held point, implicit
constexpr double kHoldDamping = 0.5;       // [N s/m]
constexpr double kFoldThickness = 0.0025;  // [m] a pinched fold of an organ's surface
constexpr double kOpen = 0.97;             // aperture that the hand asks for when it has opened the jaws
constexpr double kLoose = 0.06;            // aperture beyond the tissue's at which jaws hold it no more
constexpr double kCompressed = 0.7;        // thickness of a strand between jaws that just hold it, of its diameter

/// What lies between the jaws: of many points some of all, evenly.
struct Candidate {
  Hold hold[kMaxHolds];
  int count = 0;         ///< held
  int found = 0;         ///< all of them
  int stride = 1;        ///< every so many of those found is held
  double thickness = 0;  ///< how far they keep the jaws apart [m]
  double sum = 0;        ///< of the way along the jaws of those found
  bool firmly = false;   ///< some lie beside the jaws: it slips away from a light pinch
  double along() const noexcept { return sum / found; }
};

void add(Candidate& c, std::int32_t body, int element, double w, Vec3d local) noexcept {
  c.sum += local.z;
  if (c.found++ % c.stride != 0) return;
  if (c.count == kMaxHolds) {
    c.count /= 2;
    for (int i = 0; i < c.count; ++i) c.hold[i] = c.hold[2 * i];
    c.stride *= 2;
  }
  Hold& h = c.hold[c.count++];
  h = {};
  h.body = body;
  h.element = element;
  h.weight = float(w);
  h.local[0] = float(local.x);
  h.local[1] = float(local.y);
  h.local[2] = float(local.z);
}

/// The strand that lies deepest between the jaws.
Candidate strand_between(const ToolModel& model, const ToolShape& shape, const TissueView& view) noexcept {
  Candidate best;
  for (size_t s = 0; s < view.strands.size(); ++s) {
    const StrandBody& body = view.strands[s];
    Candidate c;
    for (int e = 0; e + 1 < body.nodes(); ++e) {
      if (!view.strand_states[s].alive[size_t(e)]) continue;
      const BetweenJaws where = between_jaws(model, shape, body, view.strand_states[s], e);
      if (!where.inside || where.local.z > model.jaw_length || where.local.z < 0) continue;
      add(c, std::int32_t(s), e, where.w, where.local);
      c.thickness = std::max(c.thickness, 2 * kCompressed * body.model.radius[size_t(e)]);
    }
    if (c.count == 0) continue;
    if (best.count == 0 || c.along() < best.along()) best = c;
  }
  return best;
}

/// Skin vertices of an organ that stand up between the jaws.
Candidate fold_between(const ToolModel& model, const ToolShape& shape, const TissueView& view) noexcept {
  Candidate best;
  for (size_t o = 0; o < view.solids.size(); ++o) {
    const Surface& surface = view.solids[o];
    if (!surface.pose->bounds.near_segment(shape.pivot, shape.frame.tip, 0.01)) continue;
    Candidate c;
    for (size_t b = 0; b < surface.pose->block.size(); ++b) {
      if (!surface.pose->block[b].near_segment(shape.pivot, shape.frame.tip, 0.01)) continue;
      const int last = std::min(int(b + 1) * tissue::kSkinBlock, surface.skin->size());
      for (int v = int(b) * tissue::kSkinBlock; v < last; ++v) {
        if (!surface.skin->at_surface(v) || surface.torn(v)) continue;
        const Vec3d local = to_jaw(shape, surface.position(v));
        if (std::fabs(local.y) > 0.5 * model.jaw_width + 0.0015) continue;
        if (local.z < 0.25 * model.jaw_length || local.z > model.jaw_length + 0.0005) continue;
        if (std::fabs(local.x) > shape.half_opening(local.z) + 0.0008) continue;
        add(c, kSolidBase + std::int32_t(o), v, 0, local);
      }
    }
    if (c.count < 2) continue;
    c.thickness = kFoldThickness;
    if (c.found > best.found) best = c;
  }
  return best;
}

/// Nodes of a membrane between the jaws. Those of its borders are left to what carries them.
Candidate sheet_between(const ToolModel& model, const ToolShape& shape, const TissueView& view) noexcept {
  Candidate best;
  for (size_t m = 0; m < view.membranes.size(); ++m) {
    const Surface& surface = view.membranes[m].surface;
    if (!surface.pose->bounds.near_segment(shape.pivot, shape.frame.tip, 0.01)) continue;
    Candidate c;
    const double reach = view.membranes[m].pinch_reach;
    for (int v = 0; v < surface.skin->size(); ++v) {
      if (view.membranes[m].fixed[size_t(v)] == tissue::kHeld) continue;
      const Vec3d local = to_jaw(shape, surface.position(v));
      if (std::fabs(local.y) > 0.5 * model.jaw_width + 0.0015 + reach) continue;
      if (local.z < 0 || local.z > model.jaw_length + 0.0005 + reach) continue;
      if (std::fabs(local.x) > shape.half_opening(local.z) + 0.0005 + reach) continue;
      add(c, kMembraneBase + std::int32_t(m), v, 0, local);
    }
    if (c.count < 2) continue;
    c.thickness = (reach > 0 ? 4 : 2) * view.membranes[m].half_thickness;
    c.firmly = reach > 0;
    if (c.found > best.found) best = c;
  }
  return best;
}

/// How thick what is held keeps the jaws apart [m].
double thickness_of(const Hold& hold, const TissueView& view) noexcept {
  if (hold.body >= kMembraneBase) {
    const SheetView& sheet = view.membranes[size_t(hold.body - kMembraneBase)];
    return (sheet.pinch_reach > 0 ? 4 : 2) * sheet.half_thickness;
  }
  if (hold.body >= kSolidBase) return kFoldThickness;
  return 2 * kCompressed * view.strands[size_t(hold.body)].model.radius[size_t(hold.element)];
}

/// How far beside the jaws it may be held [m].
double reach_of(const Hold& hold, const TissueView& view) noexcept {
  return hold.body >= kMembraneBase ? view.membranes[size_t(hold.body - kMembraneBase)].pinch_reach : 0;
}

/// With which the jaws press on what stops them there while the hand wants them closer [N].
double pinch_at(const ToolModel& model, double stop, double wanted) noexcept {
  return model.pinch_max * std::clamp((stop - wanted) / std::max(stop, 0.05), 0.0, 1.0);
}

constexpr float kCentring = 0.985f;  // per tick: closing jaws bring what lies between them to the middle

/// The grip is gone: a slip, unless the hand has let go.
void lose(ToolState& tool) noexcept {
  tool.holds = 0;
  tool.slipped += !tool.letting_go;
  for (double& p : tool.pull) p = 0;
}

bool grips(ToolKind kind) noexcept { return kind == ToolKind::grasper || kind == ToolKind::bipolar; }

}  // namespace

Vec3d held_point(const TissueView& view, const Hold& hold) noexcept {
  if (hold.body >= kMembraneBase)
    return view.membranes[size_t(hold.body - kMembraneBase)].surface.position(hold.element);
  if (hold.body >= kSolidBase) return view.solids[size_t(hold.body - kSolidBase)].position(hold.element);
  const tissue::StrandState& s = view.strand_states[size_t(hold.body)];
  const Vec3d a = s.x[size_t(hold.element)], b = s.x[size_t(hold.element) + 1];
  return a + double(hold.weight) * (b - a);
}

namespace {

/// A strand's element that was cut through or tore leaves the jaws: it is no place any more.
void drop_parted(const TissueView& view, ToolState& tool) noexcept {
  const auto parted = [&view](const Hold& h) {
    return h.body < kSolidBase && !view.strand_states[size_t(h.body)].alive[size_t(h.element)];
  };
  const auto end = std::remove_if(tool.hold, tool.hold + tool.holds, parted);
  tool.holds = std::int32_t(end - tool.hold);
  if (tool.holds > 0) return;
  for (double& p : tool.pull) p = 0;
}

}  // namespace

void update_grip(const ToolModel& model, const ToolShape& shape, const TissueView& view, ToolState& tool) noexcept {
  const double wanted = 1.0 - tool.handle;
  if (!grips(model.kind)) {
    tool.aperture = wanted;
    tool.pinch = 0;
    return;
  }
  if (tool.holds > 0) drop_parted(view, tool);
  if (tool.holds > 0) {
    const double stop = aperture_at(model, thickness_of(tool.hold[0], view), tool.hold[0].local[2]);
    // Loose jaws are opened by the hand, or the tissue has slid towards their tips, where they stand farther apart. An
    // open hand lets go of whatever keeps the jaws wide open.
    const double release = std::min(stop + kLoose, kOpen);
    if (wanted <= std::min(stop, kOpen))
      tool.letting_go = 0;
    else if (wanted > tool.aperture || wanted > kOpen)
      tool.letting_go = 1;
    if (wanted > release) {
      lose(tool);
    } else {
      for (int i = 0; i < tool.holds; ++i) {
        float& off = tool.hold[i].local[0];
        off = std::fabs(off) > 1e-7f ? off * kCentring : 0.0f;  // ends at 0, not among the denormal numbers
      }
      tool.aperture = std::max(wanted, stop);
      tool.pinch = pinch_at(model, stop, wanted);
      return;
    }
  }
  tool.pinch = 0;
  const bool closing = wanted < tool.aperture;
  tool.aperture = wanted;
  if (!closing) return;
  Candidate c = strand_between(model, shape, view);
  if (c.count == 0 && wanted < 0.6) c = fold_between(model, shape, view);
  if (c.count == 0) c = sheet_between(model, shape, view);
  if (c.count == 0) return;
  const double stop = aperture_at(model, c.thickness, c.along());
  if (wanted > (c.firmly ? 0.3 * stop : stop)) return;
  tool.letting_go = 0;
  tool.holds = c.count;
  for (int i = 0; i < c.count; ++i) tool.hold[i] = c.hold[i];
  tool.aperture = stop;
  if (c.firmly) tool.pinch = pinch_at(model, stop, wanted);
}

void hold_loads(const ToolShape& shape, int tool_index, const TissueView& view, const ToolState& tool,
                std::span<StrandLoads> strand_loads, std::span<NetworkLoads> organ_loads,
                std::span<NetworkLoads> membrane_loads) noexcept {
  for (int i = 0; i < tool.holds; ++i) {
    const Hold& h = tool.hold[i];
    const Vec3d target = from_jaw(shape, {h.local[0], h.local[1], h.local[2]});
    const Tag tag{Owner::tool_hold, tool_index, i};
    if (h.body >= kMembraneBase) {
      tissue::NodeLoad load;
      load.node = h.element;
      load.k = float(kHoldStiffness);
      load.d = float(kHoldDamping);
      load.x0 = vec_cast<float>(target);
      membrane_loads[size_t(h.body - kMembraneBase)].add(load, tag);
    } else if (h.body >= kSolidBase) {
      const size_t o = size_t(h.body - kSolidBase);
      const Surface& surface = view.solids[o];
      SkinLoad load;
      load.k = kHoldStiffness;
      load.d = kHoldDamping;
      load.shift = target - surface.position(h.element);
      add_skin_load(surface.nodes, *surface.skin, h.element, load, tag, organ_loads[o]);
    } else {
      tissue::StrandLoad load;
      load.element = h.element;
      load.w = h.weight;
      load.k = kHoldStiffness;
      load.d = kHoldDamping;
      load.x0 = target;
      strand_loads[size_t(h.body)].add(load, tag);
    }
  }
}

void slip(const ToolModel& model, const ToolShape& shape, const TissueView& view, ToolState& tool) noexcept {
  Vec3d pull{0, 0, 0};
  for (int i = 0; i < tool.holds; ++i)
    pull += Vec3d{tool.hold[i].force[0], tool.hold[i].force[1], tool.hold[i].force[2]};
  for (int k = 0; k < 3; ++k) tool.pull[k] = -pull[k];
  if (tool.holds == 0) return;
  const double force = length(pull), bears = model.friction * tool.pinch;
  if (force <= bears) return;
  // The tissue slides between the jaws until friction bears the pull again; what slides out is lost.
  const double give = std::min(0.5, 1.0 - bears / force);
  int kept = 0;
  for (int i = 0; i < tool.holds; ++i) {
    Hold h = tool.hold[i];
    const Vec3d now = to_jaw(shape, held_point(view, h));
    h.local[1] += float(give) * float(now.y - double(h.local[1]));
    h.local[2] += float(give) * float(now.z - double(h.local[2]));
    const double reach = reach_of(h, view);
    const bool out = double(h.local[2]) > model.jaw_length + 0.001 + reach || double(h.local[2]) < -0.002 ||
                     std::fabs(double(h.local[1])) > 0.5 * model.jaw_width + 0.003 + reach;
    if (!out) tool.hold[kept++] = h;
  }
  tool.holds = kept;
  if (kept == 0) lose(tool);
}

}  // namespace trocar::interactions
