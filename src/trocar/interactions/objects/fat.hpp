// Fat (tissue/fat/fat.hpp) as a body of a scene: what its lobules hold on, how instruments meet them, and how it is
// parted.
//
//   roots   tie lobules to strands and organs: a set of bonds (couplings/bonds.hpp), with the fat in the wall's place
//   ties    tie lobules to nodes of pouches' walls, by the same law
//   touch   a lobule is a ball; parts of instruments push it, with friction. Where jaws close on lobules they hold them
// Lobules do not touch each other, nor the bodies that they have detached from: what is torn off falls out of sight.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include <trocar/core/body_id.hpp>
#include <trocar/core/fields.hpp>
#include <trocar/interactions/couplings/bonds.hpp>
#include <trocar/interactions/objects/object_hand.hpp>
#include <trocar/tissue/fat/fat.hpp>
#include <trocar/tissue/membrane/membrane.hpp>

namespace trocar::interactions {

/// A lobule on a node of a pouch's wall.
struct FatTie {
  std::int32_t lobule = -1;
  std::int32_t membrane = -1, node = -1;
  Vec3d offset{0, 0, 0};  ///< from the node to the lobule, in the drawn shape [m]
  double area = 0;        ///< [m^2]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("lobule", s.lobule), v("membrane", s.membrane), v("node", s.node), v("offset", s.offset), v("area", s.area);
  }
};

/// Lobules that are drawn as one thing of another look: a lymph node. Mechanics know nothing of it.
struct FatNodule {
  std::string look;
  std::vector<std::int32_t> lobules;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("look", s.look, core::kNotHashed), v("lobules", s.lobules, core::kNotHashed);
  }
};

struct FatBody {
  std::string name, look;
  tissue::FatModel fat;
  BondSet roots;  ///< of its lobules; `membrane` is -1
  std::vector<FatTie> ties;
  std::vector<FatNodule> nodules;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("fat", s.fat), v("roots", s.roots), v("ties", s.ties), v("name", s.name, core::kNotHashed),
        v("look", s.look, core::kNotHashed), v("nodules", s.nodules, core::kNotHashed);
  }
};
struct FatBodies {
  std::vector<FatBody> list;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("list", s.list);
  }
};

struct FatBodyState {
  tissue::FatState fat;
  std::vector<BondState> roots, ties;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("fat", s.fat), v("roots", s.roots), v("ties", s.ties);
  }
};

struct FatBodyWork {
  tissue::FatWork fat;
  NetworkLoads loads;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("fat", s.fat), v("loads", s.loads);
  }
};
struct FatWorks {
  std::vector<FatBodyWork> list;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("list", s.list);
  }
};

/// The kind, as object_kinds.hpp lists it.
struct Fat {
  static constexpr BodyKind kKind = BodyKind::fat;
  static constexpr bool kRigidInJaws = false;
  using Models = FatBodies;
  using States = std::vector<FatBodyState>;
  using Work = FatWorks;

  template <class All>
  static auto& part(All& all) noexcept {
    return all.fat;
  }
  static int count(const Models& m) noexcept { return int(m.list.size()); }
  static const std::string& name(const Models& m, size_t i) noexcept { return m.list[i].name; }
  static const std::string& look(const Models& m, size_t i) noexcept { return m.list[i].look; }
  static int grip_point_count(const Models& m, size_t i) noexcept { return m.list[i].fat.lobules(); }

  static States start(const Models& models);
  static Work make_work(const Models& models, int hands);

  static void clear(Work& work) noexcept;
  static void touch(const Models& models, const States& states, const ObjectHand& hand, Work& work) noexcept;
  template <class Add>
  static void between(const Models& models, const States& states, size_t i, const ToolModel& tool,
                      const ToolShape& shape, Add&& add) noexcept;
  static Vec3d middle(const Models& models, const States& states, size_t i) noexcept;
  static Vec3d point(const Models& models, const States& states, const Hold& hold) noexcept;
  static double thickness(const Models& models, const Hold& hold) noexcept;
  static bool is_attached(const States& states, const Hold& hold) noexcept;
  static void pull(const Models& models, const States& states, const Hold& hold, Vec3d target, HoldLaw law, Tag tag,
                   Work& work) noexcept;
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

/// Roots and ties pull on lobules and on what they hold on, and give way.
void apply_fat_loads(const FatBody& body, FatBodyState& state, const Bodies& bodies, double dt,
                     FatBodyWork& work) noexcept;

/// Septa, roots and ties between whose ends the blade passes hold no more. @return how many
int sever_fat(const FatBody& body, const geometry::Blade& blade, const Bodies& bodies, FatBodyState& state) noexcept;

/// The lobule at an electrode: nearest to the bare wire, and touching it. -1: none
int lobule_at(const FatBody& body, const FatBodyState& state, const Capsule& wire) noexcept;

/// Current that enters at a lobule warms it and those beside it; what ties gone lobules is burnt.
/// @return water that has boiled off [kg]
double warm_fat(const FatBody& body, int lobule, double joules, FatBodyState& state) noexcept;

/// Does a ball lie between the jaws? @param local  its middle, in the jaws' frame [m]
inline bool lies_between(const ToolModel& tool, const ToolShape& shape, Vec3d local, double radius) noexcept {
  const double beside = 0.6 * radius;
  return std::fabs(local.y) <= 0.5 * tool.jaw_width + beside && local.z >= 0 && local.z <= tool.jaw_length + beside &&
         std::fabs(local.x) <= shape.half_opening(local.z) + beside;
}

template <class Add>
void Fat::between(const Models& models, const States& states, size_t i, const ToolModel& tool, const ToolShape& shape,
                  Add&& add) noexcept {
  const tissue::FatModel& m = models.list[i].fat;
  const tissue::FatState& s = states[i].fat;
  for (int n = 0; n < m.lobules(); ++n) {
    if (s.lobules[size_t(n)].gone()) continue;
    const Vec3d local = to_jaw(shape, tissue::position(m, s, n));
    if (!lies_between(tool, shape, local, m.radius)) continue;
    add(std::int32_t(n), local);
  }
}

template <class Account>
void Fat::account(const Work& work, double /*tick*/, Account&& account) noexcept {
  for (const FatBodyWork& w : work.list)
    for (size_t i = 0; i < w.loads.sorted.size(); ++i) account(w.loads.owner[i], vec_cast<double>(w.loads.reaction[i]));
}

template <class States_, class F>
void Fat::serialize_display(const Models& models, States_& states, F&& f) {
  constexpr bool kWrites = std::is_const_v<States_>;
  constexpr double kStep = 1e-5, kMost = 32000;  // [m], steps
  for (size_t i = 0; i < states.size(); ++i) {
    const tissue::FatModel& m = models.list[i].fat;
    auto& s = states[i].fat;
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
