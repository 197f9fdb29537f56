#include <trocar/interactions/verbs/held.hpp>

namespace trocar::interactions {
namespace {

constexpr double kFoldThickness = 0.0025;  // [m] a pinched fold of an organ's surface
constexpr double kCompressed = 0.7;        // thickness of a strand between jaws that just hold it, of its diameter

/// A held point as its kind of body sees it.
struct OnStrand {
  const StrandBody& body;
  const tissue::StrandState& state;
  size_t index;
};
struct OnOrgan {
  const Surface& surface;
  size_t index;
};
struct OnMembrane {
  const SheetView& sheet;
  size_t index;
};
template <class K>
struct OnObject {
  const typename K::Models& models;
  const typename K::States& states;
};

/// f(place on a body of that kind); of nothing: `otherwise`.
template <class Result, class F>
Result on_body(const Bodies& bodies, BodyId body, Result otherwise, F&& f) noexcept {
  const size_t i = body.index();
  switch (body.kind()) {
    case BodyKind::strand:
      return f(OnStrand{bodies.strand(i), bodies.strand_state(i), i});
    case BodyKind::organ:
      return f(OnOrgan{bodies.organ(i), i});
    case BodyKind::membrane:
      return f(OnMembrane{bodies.membrane(i), i});
    default:
      break;
  }
  Result result = otherwise;
  visit_object(body, [&](auto kind) {
    using K = decltype(kind);
    result = f(OnObject<K>{models_of<K>(bodies), states_of<K>(bodies)});
  });
  return result;
}

Vec3d point(const OnStrand& on, const Hold& hold) noexcept {
  const Vec3d a = on.state.x[size_t(hold.element)], b = on.state.x[size_t(hold.element) + 1];
  return a + double(hold.weight) * (b - a);
}
Vec3d point(const OnOrgan& on, const Hold& hold) noexcept { return on.surface.position(hold.element); }
Vec3d point(const OnMembrane& on, const Hold& hold) noexcept { return on.sheet.surface.position(hold.element); }
template <class K>
Vec3d point(const OnObject<K>& on, const Hold& hold) noexcept {
  return K::point(on.models, on.states, hold);
}

Vec3d drawn(const OnStrand& on, const Hold& hold) noexcept {
  return {arc_at(on.body, {hold.element, double(hold.weight)}), 0, 0};
}
Vec3d drawn(const OnOrgan& on, const Hold& hold) noexcept {
  return vec_cast<double>(on.surface.skin->rest[size_t(hold.element)]);
}
Vec3d drawn(const OnMembrane& on, const Hold& hold) noexcept {
  return vec_cast<double>(on.sheet.surface.skin->rest[size_t(hold.element)]);
}

/// Objects have no frame of heat: current does nothing to them.
template <class K>
Vec3d drawn(const OnObject<K>&, const Hold&) noexcept {
  return {};
}

bool is_attached(const OnStrand& on, const Hold& hold) noexcept { return on.state.alive[size_t(hold.element)] != 0; }
bool is_attached(const OnOrgan& on, const Hold& hold) noexcept {
  return hold.element < on.surface.skin->size() && !on.surface.torn(hold.element);
}
bool is_attached(const OnMembrane&, const Hold&) noexcept { return true; }
template <class K>
bool is_attached(const OnObject<K>& on, const Hold& hold) noexcept {
  return K::is_attached(on.states, hold);
}

double thickness(const OnStrand& on, const Hold& hold) noexcept {
  return 2 * kCompressed * on.body.model.radius[size_t(hold.element)];
}
double thickness(const OnOrgan&, const Hold&) noexcept { return kFoldThickness; }
double thickness(const OnMembrane& on, const Hold&) noexcept {
  return (on.sheet.pinch_reach > 0 ? 4 : 2) * on.sheet.half_thickness;
}

template <class K>
double thickness(const OnObject<K>& on, const Hold& hold) noexcept {
  return K::thickness(on.models, hold);
}

double reach(const OnStrand&) noexcept { return 0; }
template <class K>
double reach(const OnObject<K>&) noexcept {
  return 0;
}
double reach(const OnOrgan&) noexcept { return 0; }
double reach(const OnMembrane& on) noexcept { return on.sheet.pinch_reach; }

void pull(const OnStrand& on, const Hold& hold, Vec3d target, HoldLaw law, Tag tag, const Bodies& bodies) noexcept {
  tissue::StrandLoad load;
  load.element = hold.element;
  load.w = double(hold.weight);
  load.k = law.stiffness;
  load.d = law.damping;
  load.x0 = target;
  bodies.work->strands[on.index].loads.add(load, tag);
}
void pull(const OnOrgan& on, const Hold& hold, Vec3d target, HoldLaw law, Tag tag, const Bodies& bodies) noexcept {
  SkinLoad load;
  load.k = law.stiffness;
  load.d = law.damping;
  load.shift = target - on.surface.position(hold.element);
  add_skin_load(on.surface.nodes, *on.surface.skin, hold.element, load, tag, bodies.work->organs[on.index].loads);
}
void pull(const OnMembrane& on, const Hold& hold, Vec3d target, HoldLaw law, Tag tag, const Bodies& bodies) noexcept {
  tissue::NodeLoad load;
  load.node = hold.element;
  load.k = float(law.stiffness);
  load.d = float(law.damping);
  load.x0 = vec_cast<float>(target);
  bodies.work->membranes[on.index].loads.add(load, tag);
}
template <class K>
void pull(const OnObject<K>& on, const Hold& hold, Vec3d target, HoldLaw law, Tag tag, const Bodies& bodies) noexcept {
  K::pull(on.models, on.states, hold, target, law, tag, work_of<K>(bodies));
}

}  // namespace

Vec3d held_point(const Bodies& bodies, const Hold& hold) noexcept {
  return on_body(bodies, hold.body, Vec3d{}, [&](const auto& on) { return point(on, hold); });
}
Vec3d drawn_point(const Bodies& bodies, const Hold& hold) noexcept {
  return on_body(bodies, hold.body, Vec3d{}, [&](const auto& on) { return drawn(on, hold); });
}
bool is_whole(const Bodies& bodies, const Hold& hold) noexcept {
  return on_body(bodies, hold.body, false, [&](const auto& on) { return is_attached(on, hold); });
}
double held_thickness(const Bodies& bodies, const Hold& hold) noexcept {
  return on_body(bodies, hold.body, 0.0, [&](const auto& on) { return thickness(on, hold); });
}
double held_reach(const Bodies& bodies, const Hold& hold) noexcept {
  return on_body(bodies, hold.body, 0.0, [&](const auto& on) { return reach(on); });
}
void pull_to(const Bodies& bodies, const Hold& hold, Vec3d target, HoldLaw law, Tag tag) noexcept {
  on_body(bodies, hold.body, false, [&](const auto& on) { return pull(on, hold, target, law, tag, bodies), true; });
}

}  // namespace trocar::interactions
