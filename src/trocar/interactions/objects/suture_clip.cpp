#include <algorithm>
#include <array>
#include <cmath>

#include <trocar/interactions/instrument/tool_contact.hpp>
#include <trocar/interactions/objects/suture_clip.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::interactions {
namespace {

constexpr double kOneStretch = 0.002;  // [m] of thread: crossings that are nearer are one stretch

/// Stretches of a thread between the legs, by how far along them they lie.
struct Legs {
  std::int32_t count = 0;
  std::array<double, suture::kMostClipped> s{}, along{};  ///< on the thread; from the jaws' pivot [m]

  void add(double arc, double z) noexcept {
    for (std::int32_t i = 0; i < count; ++i)
      if (std::fabs(s[size_t(i)] - arc) < kOneStretch) return;
    if (count == suture::kMostClipped) return;
    std::int32_t at = count++;
    for (; at > 0 && along[size_t(at) - 1] > z; --at)
      s[size_t(at)] = s[size_t(at) - 1], along[size_t(at)] = along[size_t(at) - 1];
    s[size_t(at)] = arc, along[size_t(at)] = z;
  }
};

/// Calls `found(e, where)` for each element that crosses the middle plane between the legs.
template <class Found>
void each_between(const SutureModel& m, const SutureState& s, const ToolModel& tool, const ToolShape& shape,
                  Found&& found) noexcept {
  const double near = tool.jaw_length + 0.005, radius = 0.5 * m.thread.stuff.diameter;
  for (std::int32_t e = 0; e + 1 < m.thread.nodes; ++e) {
    const Vec3d a = s.thread.x[size_t(e)], b = s.thread.x[size_t(e) + 1], off = a - shape.pivot;
    if (!s.thread.alive[size_t(e)] || dot(off, off) > near * near) continue;
    const BetweenJaws where = between_jaws(tool, shape, a, b, radius);
    if (!where.crosses || where.local.z < 0 || where.local.z > tool.jaw_length) continue;
    if (std::fabs(where.local.x) > shape.half_opening(where.local.z) + kClipGathers) continue;
    found(e, where);
  }
}

Legs between_legs(const SutureModel& m, const SutureState& s, const ToolModel& tool, const ToolShape& shape) noexcept {
  Legs legs;
  each_between(m, s, tool, shape, [&](std::int32_t e, const BetweenJaws& where) {
    if (leg_cover(from_bend(tool, where.local.z), 0.5 * m.thread.stuff.diameter, tool.clip_length) > 0)
      legs.add((e + where.w) * m.thread.spacing, where.local.z);
  });
  return legs;
}

}  // namespace

void gather_thread(const SutureModel& m, const SutureState& s, const ToolModel& tool, const ToolShape& shape,
                   std::vector<std::uint8_t>& gathered) noexcept {
  const double wide = shape.rod(kJawA).radius + 0.5 * m.thread.stuff.diameter;
  each_between(m, s, tool, shape, [&](std::int32_t crossing, const BetweenJaws&) {
    gathered[size_t(crossing)] = 1;
    for (const int step : {-1, 1})
      for (std::int32_t e = crossing + step; e >= 0 && e + 1 < m.thread.nodes; e += step) {
        const Vec3d enters = s.thread.x[size_t(step < 0 ? e + 1 : e)];
        if (!s.thread.alive[size_t(e)] || std::fabs(to_jaw(shape, enters).y) > wide) break;
        gathered[size_t(e)] = 1;
      }
  });
}

ThreadClipping clip_thread(const SutureModels& models, const ToolModel& tool, const ToolShape& shape,
                           std::int32_t number, Suture::States& states, Clip& clip) noexcept {
  Legs most;
  size_t on = 0;
  for (size_t i = 0; i < states.size(); ++i) {
    const Legs legs = between_legs(models.list[i], states[i], tool, shape);
    if (legs.count > most.count) most = legs, on = i;
  }
  if (most.count == 0) return ThreadClipping::no_thread;
  const suture::ThreadModel& thread = models.list[on].thread;
  suture::ThreadState& state = states[on].thread;
  const Vec3d axis = shape.frame.axis(), open = shape.frame.opening();
  if (!suture::set_clip(thread, state, number, {most.s.data(), size_t(most.count)}, axis, open))
    return ThreadClipping::no_room;
  const size_t e = size_t(suture::place_at(thread, most.s[0]).element);
  const Vec3d along = normalised(state.x[e + 1] - state.x[e]);
  clip.vessel = -std::int32_t(on) - 1;
  clip.s = most.s[0];
  clip.cover = 1;
  clip.theta = portable::acos(std::min(1.0, std::fabs(dot(shape.frame.normal(), along))));
  clip.reach = from_bend(tool, 0.5 * (most.along[0] + most.along[size_t(most.count) - 1]));
  return ThreadClipping::set;
}

const suture::ThreadClip* thread_clip(const Suture::States& states, const Clip& clip, std::int32_t number) noexcept {
  if (!clip.on_thread() || size_t(clip.suture()) >= states.size()) return nullptr;
  return suture::clip_of(states[size_t(clip.suture())].thread, number);
}

}  // namespace trocar::interactions
