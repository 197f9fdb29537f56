// Fat (tissue/fat/fat.hpp) as a body of a scene: what its lobules hold on, how instruments meet them, and how it is
// parted.
//
//   roots   tie lobules to rods, organs and walls: a set of bonds (couplings/bonds.hpp)
//   touch   a lobule is a ball; parts of instruments push it, with friction. Where jaws close on lobules they hold them
// Lobules do not touch each other, nor the bodies that they have detached from: what is torn off falls out of sight.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/interactions/bodies/fat_body.hpp>
#include <trocar/interactions/objects/object_hand.hpp>

namespace trocar::interactions {

/// The kind, as object_kinds.hpp lists it.
struct Fat {
  static constexpr BodyKind kKind = BodyKind::fat;
  static constexpr bool kIsTissue = true;
  static constexpr bool kRigidInJaws = false;
  using Models = std::vector<FatBody>;
  using States = std::vector<tissue::FatState>;
  using Work = std::vector<FatBodyWork>;

  template <class All>
  static auto& part(All& all) noexcept {
    return all.fat;
  }
  static int count(const Models& m) noexcept { return int(m.size()); }
  static const std::string& name(const Models& m, size_t i) noexcept { return m[i].name; }
  static const std::string& look(const Models& m, size_t i) noexcept { return m[i].look; }
  static int grip_point_count(const Models& m, size_t i) noexcept { return m[i].fat.lobules(); }

  static States start(const Models& models);
  static Work make_work(const Models& models, int hands);

  static void clear(Work& work) noexcept;
  static void touch(const Models& models, const States& states, const ObjectHand& hand, Work& work) noexcept;
  template <class Add>
  static void between(const Models& models, const States& states, size_t i, const ToolModel& tool,
                      const ToolShape& shape, Add&& add) noexcept;
  static Vec3d middle(const Models& models, const States& states, size_t i) noexcept;
  /// Between jaws that just hold it [m].
  static double thickness(const FatBody& body) noexcept;
  static tissue::StepReport advance(const Models& models, Vec3d gravity, double tick, const tissue::Box& cavity,
                                    States& states, Work& work) noexcept;
  static bool overloaded(const Work& work) noexcept;
  template <class Account>
  static void account(const Work& work, double tick, Account&& account) noexcept;
  /// Does a lobule lie between the two points?
  static bool hides(const Models& models, const States& states, Vec3d from, Vec3d to) noexcept;

  /// Places to 10 um beside the drawn ones, which septa hold, and which lobules are gone.
  template <class States_, class F>
  static void serialize_display(const Models& models, States_& states, F&& f);
  static bool is_valid(const States& states) noexcept;
  static void blend(const States& a, const States& b, double f, States& out) noexcept;
};

/// Septa between whose ends the blade passes hold no more. @return how many
int sever_septa(const FatBody& body, const geometry::Blade& blade, tissue::FatState& state) noexcept;

/// The lobule at an electrode: nearest to the bare wire, and touching it. -1: none
int lobule_at(const FatBody& body, const tissue::FatState& state, const Capsule& wire) noexcept;

/// Current that enters at a lobule warms it and those beside it.
/// @return water that has boiled off [kg]
double warm_fat(const FatBody& body, int lobule, double joules, tissue::FatState& state) noexcept;

/// Does a ball lie between the jaws? @param local  its middle, in the jaws' frame [m]
inline bool lies_between(const ToolModel& tool, const ToolShape& shape, Vec3d local, double radius) noexcept {
  const double beside = 0.6 * radius;
  return std::fabs(local.y) <= 0.5 * tool.jaw_width + beside && local.z >= 0 && local.z <= tool.jaw_length + beside &&
         std::fabs(local.x) <= shape.half_opening(local.z) + beside;
}

template <class Add>
void Fat::between(const Models& models, const States& states, size_t i, const ToolModel& tool, const ToolShape& shape,
                  Add&& add) noexcept {
  const tissue::FatModel& m = models[i].fat;
  const tissue::FatState& s = states[i];
  for (int n = 0; n < m.lobules(); ++n) {
    if (s.lobules[size_t(n)].gone()) continue;
    const Vec3d local = to_jaw(shape, tissue::position(m, s, n));
    if (!lies_between(tool, shape, local, m.radius)) continue;
    add(std::int32_t(n), local);
  }
}

template <class Account>
void Fat::account(const Work& work, double /*tick*/, Account&& account) noexcept {
  for (const FatBodyWork& w : work)
    for (size_t i = 0; i < w.loads.sorted.size(); ++i) account(w.loads.owner[i], vec_cast<double>(w.loads.reaction[i]));
}

template <class States_, class F>
void Fat::serialize_display(const Models& models, States_& states, F&& f) {
  constexpr bool kWrites = std::is_const_v<States_>;
  constexpr double kStep = 1e-5, kMost = 32000;  // [m], steps
  for (size_t i = 0; i < states.size(); ++i) {
    const tissue::FatModel& m = models[i].fat;
    auto& s = states[i];
    std::vector<std::int16_t> at(3 * size_t(m.lobules()));
    std::vector<std::uint8_t> marks(size_t(m.lobules())), septa(size_t(m.septa()));
    if constexpr (kWrites) {
      for (int n = 0; n < m.lobules(); ++n) {
        const Vec3d off = (tissue::position(m, s, n) - m.network.rest[size_t(n)]) / kStep;
        for (int c = 0; c < 3; ++c) at[size_t(3 * n + c)] = std::int16_t(std::clamp(off[c], -kMost, kMost));
        marks[size_t(n)] = std::uint8_t(s.lobules[size_t(n)].marks);
      }
      for (int k = 0; k < m.septa(); ++k) septa[size_t(k)] = std::uint8_t(255 * std::min(1.0, holding(m, s, k)));
    }
    f(at.data(), at.size());
    f(marks.data(), marks.size());
    f(septa.data(), septa.size());
    if constexpr (!kWrites) {
      s.gone = 0;
      for (int n = 0; n < m.lobules(); ++n) {
        Vec3d off;
        for (int c = 0; c < 3; ++c) off[c] = kStep * double(at[size_t(3 * n + c)]);
        tissue::set_position(m.network, s.network, n, m.network.rest[size_t(n)] + off);
        s.lobules[size_t(n)].marks = marks[size_t(n)] & (tissue::Lobule::kCoagulated | tissue::Lobule::kBoiledAway);
        s.gone += s.lobules[size_t(n)].gone();
      }
      for (int k = 0; k < m.septa(); ++k)
        tissue::set_spring_scale(m.network, s.network, k, float(septa[size_t(k)]) / 255.0f);
    }
  }
}

}  // namespace trocar::interactions
