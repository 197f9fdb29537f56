#include <algorithm>

#include <trocar/interactions/instrument/tool_contact.hpp>
#include <trocar/interactions/verbs/grasp.hpp>

namespace trocar::interactions {
namespace {

constexpr HoldLaw kHold{1200, 0.5};  // per held point, implicit
constexpr double kOpen = 0.97;       // aperture that the hand asks for when it has opened the jaws
constexpr double kLoose = 0.06;      // aperture beyond the tissue's at which jaws hold it no more

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

/// @param point  makes the MaterialPoint, where it is wanted
template <class Point>
void add_held(Candidate& c, Vec3d local, Point&& point) noexcept {
  c.sum += local.z;
  if (c.found++ % c.stride != 0) return;
  if (c.count == kMaxHolds) {
    c.count /= 2;
    for (int i = 0; i < c.count; ++i) c.hold[i] = c.hold[2 * i];
    c.stride *= 2;
  }
  Hold& h = c.hold[c.count++];
  h = {};
  h.at = point();
  h.local[0] = float(local.x);
  h.local[1] = float(local.y);
  h.local[2] = float(local.z);
}

/// The strand that lies deepest between the jaws.
Candidate strand_between(const ToolModel& model, const ToolShape& shape, const Bodies& bodies) noexcept {
  Candidate best;
  for (size_t s = 0; s < bodies.strand_count(); ++s) {
    const StrandBody& body = bodies.strand(s);
    Candidate c;
    for (int e = 0; e + 1 < body.nodes(); ++e) {
      if (!bodies.strand_state(s).alive[size_t(e)]) continue;
      const BetweenJaws where = between_jaws(model, shape, body, bodies.strand_state(s), e);
      if (!where.inside || where.local.z > model.jaw_length || where.local.z < 0) continue;
      const MaterialPoint at = at_element(bodies, s, e, where.w, {});
      add_held(c, where.local, [&at] { return at; });
      c.thickness = std::max(c.thickness, held_thickness(bodies, at));
    }
    if (c.count == 0) continue;
    if (best.count == 0 || c.along() < best.along()) best = c;
  }
  return best;
}

/// Skin vertices of an organ that stand up between the jaws.
Candidate fold_between(const ToolModel& model, const ToolShape& shape, const Bodies& bodies) noexcept {
  Candidate best;
  for (size_t o = 0; o < bodies.organ_count(); ++o) {
    const Surface& surface = bodies.organ(o);
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
        add_held(c, local, [&] { return on_vertex(bodies, o, v); });
      }
    }
    if (c.count < 2) continue;
    c.thickness = held_thickness(bodies, c.hold[0].at);
    if (c.found > best.found) best = c;
  }
  return best;
}

/// Nodes of a membrane between the jaws. Those of its borders are left to what carries them.
Candidate sheet_between(const ToolModel& model, const ToolShape& shape, const Bodies& bodies) noexcept {
  Candidate best;
  for (size_t m = 0; m < bodies.membrane_count(); ++m) {
    const Surface& surface = bodies.membrane(m).surface;
    if (!surface.pose->bounds.near_segment(shape.pivot, shape.frame.tip, 0.01)) continue;
    Candidate c;
    const double reach = bodies.membrane(m).pinch_reach;
    for (int v = 0; v < surface.skin->size(); ++v) {
      if (bodies.membrane(m).fixed[size_t(v)] == tissue::kHeld) continue;
      const Vec3d local = to_jaw(shape, surface.position(v));
      if (std::fabs(local.y) > 0.5 * model.jaw_width + 0.0015 + reach) continue;
      if (local.z < 0 || local.z > model.jaw_length + 0.0005 + reach) continue;
      if (std::fabs(local.x) > shape.half_opening(local.z) + 0.0005 + reach) continue;
      add_held(c, local, [&] { return at_node(bodies, BodyId::membrane(m), v); });
    }
    if (c.count < 2) continue;
    c.thickness = held_thickness(bodies, c.hold[0].at);
    c.firmly = reach > 0;
    if (c.found > best.found) best = c;
  }
  return best;
}

/// Places of an object between the jaws.
Candidate object_between(const ToolModel& model, const ToolShape& shape, const Bodies& bodies) noexcept {
  Candidate best;
  if (!bodies.objects.models) return best;
  visit_objects(bodies, [&](auto kind, BodyId body) {
    using K = decltype(kind);
    Candidate c;
    K::between(
        models_of<K>(bodies), states_of<K>(bodies), body.index(), model, shape, [&](std::int32_t place, Vec3d local) {
          add_held(c, local, [&] { return K::kIsTissue ? at_node(bodies, body, place) : on_object(body, place); });
        });
    if (c.count < 2) return;
    c.thickness = held_thickness(bodies, c.hold[0].at);
    if (c.found > best.found) best = c;
  });
  return best;
}

/// With which the jaws press on what stops them there while the hand wants them closer [N].
double pinch_at(const ToolModel& model, double stop, double wanted) noexcept {
  if (!model.linkage.there) return model.pinch_max * std::clamp((stop - wanted) / std::max(stop, 0.05), 0.0, 1.0);
  // The same of the handle's ways, times the leverage that the linkage has where the jaws are stopped.
  const double left = 1.0 - handle_of(model.linkage, stop), gone = left - (1.0 - handle_of(model.linkage, wanted));
  return model.pinch_max * leverage_at(model.linkage, stop) * std::clamp(gone / std::max(left, 0.05), 0.0, 1.0);
}

constexpr double kSlides = 0.99;     // of what friction bears: what has slid up to there may have left the jaws
constexpr float kCentring = 0.985f;  // per tick: closing jaws bring what lies between them to the middle

/// Tissue gives way to the middle point by point, what is hard as a whole.
void centre(ToolState& tool) noexcept {
  const auto closer = [](float off) {
    return std::fabs(off) > 1e-7f ? off * kCentring : 0.0f;  // ends at 0, not among the denormal numbers
  };
  if (!is_hard(tool.hold[0].at.body)) {
    for (int i = 0; i < tool.holds; ++i) tool.hold[i].local[0] = closer(tool.hold[i].local[0]);
    return;
  }
  float middle = 0;
  for (int i = 0; i < tool.holds; ++i) middle += tool.hold[i].local[0] / float(tool.holds);
  for (int i = 0; i < tool.holds; ++i) tool.hold[i].local[0] += closer(middle) - middle;
}

/// The grip is gone: a slip, unless the hand has let go.
void lose(ToolState& tool) noexcept {
  tool.holds = 0;
  tool.slipped += !tool.letting_go;
  for (double& p : tool.pull) p = 0;
}

/// A strand's element that was cut through or tore, a lobule that has boiled away: it is no place any more.
void drop_parted(const Bodies& bodies, ToolState& tool) noexcept {
  const auto parted = [&bodies](const Hold& h) { return !h.at.body.is(BodyKind::organ) && !is_whole(bodies, h.at); };
  const auto end = std::remove_if(tool.hold, tool.hold + tool.holds, parted);
  tool.holds = std::int32_t(end - tool.hold);
  if (tool.holds > 0) return;
  for (double& p : tool.pull) p = 0;
}

}  // namespace

void update_grip(const ToolModel& model, const ToolShape& shape, const Bodies& bodies, ToolState& tool) noexcept {
  const double wanted = aperture_of(model.linkage, tool.handle);
  if (!model.can().grip) {
    tool.aperture = wanted;
    tool.pinch = 0;
    return;
  }
  if (tool.holds > 0) drop_parted(bodies, tool);
  if (tool.holds > 0) {
    const double stop = aperture_at(model, held_thickness(bodies, tool.hold[0].at), tool.hold[0].local[2]);
    // Loose jaws are opened by the hand, or the tissue has slid towards their tips, where they stand further apart. An
    // open hand lets go of whatever keeps the jaws wide open.
    const double release = std::min(stop + kLoose, kOpen);
    if (wanted <= std::min(stop, kOpen))
      tool.letting_go = 0;
    else if (wanted > tool.aperture || wanted > kOpen)
      tool.letting_go = 1;
    if (wanted > release) {
      lose(tool);
    } else {
      centre(tool);
      tool.aperture = std::max(wanted, stop);
      tool.pinch = pinch_at(model, stop, wanted);
      return;
    }
  }
  tool.pinch = 0;
  const bool closing = wanted < tool.aperture;
  tool.aperture = wanted;
  if (!closing) return;
  Candidate c = object_between(model, shape, bodies);
  if (c.count == 0) c = strand_between(model, shape, bodies);
  if (c.count == 0 && wanted < 0.6) c = fold_between(model, shape, bodies);
  if (c.count == 0) c = sheet_between(model, shape, bodies);
  if (c.count == 0) return;
  const double stop = aperture_at(model, c.thickness, c.along());
  if (wanted > (c.firmly ? 0.3 * stop : stop)) return;
  tool.letting_go = 0;
  tool.holds = c.count;
  for (int i = 0; i < c.count; ++i) tool.hold[i] = c.hold[i];
  tool.aperture = stop;
  if (c.firmly) tool.pinch = pinch_at(model, stop, wanted);
}

void hold_loads(const ToolShape& shape, int tool_index, const Bodies& bodies, const ToolState& tool) noexcept {
  for (int i = 0; i < tool.holds; ++i) {
    const Hold& h = tool.hold[i];
    const Vec3d target = from_jaw(shape, {h.local[0], h.local[1], h.local[2]});
    pull_to(bodies, h.at, target, kHold, {Owner::tool_hold, tool_index, i});
  }
}

void slip(const ToolModel& model, const ToolShape& shape, const Bodies& bodies, ToolState& tool) noexcept {
  Vec3d pull{0, 0, 0};
  for (int i = 0; i < tool.holds; ++i)
    pull += Vec3d{tool.hold[i].force[0], tool.hold[i].force[1], tool.hold[i].force[2]};
  for (int k = 0; k < 3; ++k) tool.pull[k] = -pull[k];
  if (tool.holds == 0) return;
  const double force = length(pull), bears = model.friction * tool.pinch;
  if (force <= kSlides * bears) return;
  // The tissue slides between the jaws until friction bears the pull again; what slides out is lost.
  const double give = std::clamp(1.0 - bears / force, 0.0, 0.5);
  int kept = 0;
  for (int i = 0; i < tool.holds; ++i) {
    Hold h = tool.hold[i];
    const Vec3d now = to_jaw(shape, held_point(bodies, h.at));
    h.local[1] += float(give) * float(now.y - double(h.local[1]));
    h.local[2] += float(give) * float(now.z - double(h.local[2]));
    const double reach = held_reach(bodies, h.at.body);
    const bool out = double(h.local[2]) > model.jaw_length + 0.001 + reach || double(h.local[2]) < -0.002 ||
                     std::fabs(double(h.local[1])) > 0.5 * model.jaw_width + 0.003 + reach;
    if (!out) tool.hold[kept++] = h;
  }
  tool.holds = kept;
  if (kept == 0) lose(tool);
}

}  // namespace trocar::interactions
