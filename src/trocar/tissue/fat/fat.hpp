// Fat and the loose areolar tissue in it, as surgeons meet it around ducts and vessels: lobules of some millimetres
// that septa tie to their neighbours, on its free faces covered by serosa. It is teased apart, cut, coagulated and
// boiled away, lobule by lobule.
//
//   septa   springs of a network (tissue/network/network.hpp) between neighbours. Each holds by a cohesive law
//           (tissue/failure/cohesive.hpp): what has been opened does not heal. Between lobules of a free face the
//           spring is serosa instead, stiffer and tougher
//   heat    a lobule keeps what current gives it: it warms to 100 C, then its water boils. From 60 C on it is
//           coagulated: what ties it bears a fifth of what it did. Without water it is gone, with its mass and volume
//           booked
// All figures of strength and heat are our choice between those of other tissues (docs/science/fat.md).
//
//   const FatModel model = build(description, 1e-3);
//   FatState state = rest_state(model);  FatWork work = make_work(model);
//   StepReport r = advance(model, loads, reactions, state, work);   // 1 ms
//   sever(model, plane, state);                                     // closed blades
//   warm(model, lobule, joules, state);                             // current
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/geometry/tets/blade.hpp>
#include <trocar/tissue/failure/cohesive.hpp>
#include <trocar/tissue/network/network.hpp>

namespace trocar::tissue {

/// What it is made of.
struct FatMaterial {
  double density = 920;     ///< [kg/m^3]
  double young = 3000;      ///< small-strain, of lobules and septa together [Pa]
  double yields = 0.6;      ///< strain at which a septum bears most
  double opens = 1.2;       ///< strain at which it is gone
  double serosa = 50;       ///< Young's modulus times thickness [N/m]; 0: none
  double serosa_opens = 1;  ///< strain at which it is gone
  double water = 0.15;      ///< share of its mass
  double damping = 0.002;   ///< along springs, times their stiffness [s]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("density", s.density), v("young", s.young), v("yields", s.yields), v("opens", s.opens), v("serosa", s.serosa),
        v("serosa_opens", s.serosa_opens), v("water", s.water), v("damping", s.damping);
  }
};

struct FatDescription {
  std::vector<Vec3d> lobules;      ///< middles [m]
  std::vector<std::uint8_t> free;  ///< (lobules) 1: on a free face, under serosa
  std::vector<std::uint8_t> held;  ///< (lobules) 1: does not move in space; may be empty
  double spacing = 0.0025;         ///< of lobules [m]
  FatMaterial material;
  Vec3d gravity{0, 0, 0};
};

/// Const after build().
struct FatModel {
  NetworkModel network;  ///< a node a lobule, a spring a septum
  FatMaterial material;
  double spacing = 0;                 ///< [m]
  double radius = 0;                  ///< of a lobule, as it is touched [m]
  double volume = 0;                  ///< of a lobule [m^3]
  double mass = 0;                    ///< of a lobule [kg]
  std::vector<std::uint8_t> serosal;  ///< (septa) 1: serosa
  CohesiveLaw septum, serosa;         ///< openings of a septum of the mean length

  int lobules() const noexcept { return network.nodes; }
  int septa() const noexcept { return network.springs; }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("network", s.network), v("spacing", s.spacing), v("radius", s.radius), v("volume", s.volume), v("mass", s.mass),
        v("serosal", s.serosal), v("septum", s.septum), v("serosa", s.serosa), v("material", s.material);
  }
};

/// What a lobule has been through. No padding.
struct Lobule {
  enum Mark : std::int32_t { kCoagulated = 1, kBoiledAway = 2 };
  double heat = 0;         ///< above body temperature, without what has boiled [J]
  double boiled = 0;       ///< of its water [kg]
  std::int32_t marks = 0;  ///< Mark
  std::int32_t unused = 0;

  bool gone() const noexcept { return (marks & kBoiledAway) != 0; }
  bool coagulated() const noexcept { return (marks & kCoagulated) != 0; }

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("heat", s.heat), v("boiled", s.boiled), v("marks", s.marks), v("unused", s.unused);
  }
};

struct FatState {
  NetworkState network;
  std::vector<Lobule> lobules;
  std::int32_t gone = 0;     ///< lobules that are
  std::int32_t severed = 0;  ///< septa that blades have cut
  std::uint64_t tick = 0;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("network", s.network), v("lobules", s.lobules), v("gone", s.gone), v("severed", s.severed), v("tick", s.tick);
  }
};

/// Scratch.
struct FatWork {
  NetworkWork network;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("network", s.network);
  }
};

/// Throws std::invalid_argument, as a network does.
FatModel build(const FatDescription& description, double tick);
FatState rest_state(const FatModel& model);
FatWork make_work(const FatModel& model);

/// One tick; loads and reactions as for a network. Septa give way, lobules cool.
StepReport advance(const FatModel& model, std::span<const NodeLoad> loads, std::span<Vec3f> reactions, FatState& state,
                   FatWork& work) noexcept;

Vec3d position(const FatModel& model, const FatState& state, int lobule) noexcept;
Vec3d velocity(const FatModel& model, const FatState& state, int lobule) noexcept;

/// How much of a septum holds, 0 .. 1.
double holding(const FatModel& model, const FatState& state, int septum) noexcept;
/// Between which lobules it is.
inline int septum_end(const FatModel& model, int septum, int end) noexcept {
  return model.network.spring_nodes[std::size_t(2 * septum + end)];
}

/// Septa that the blade passes hold no more. @return how many
int sever(const FatModel& model, const geometry::BladePlane& blade, FatState& state) noexcept;

/// Gives a lobule heat. @return water that has boiled off [kg]
double warm(const FatModel& model, int lobule, double joules, FatState& state) noexcept;
/// [C]
double temperature(const FatModel& model, const FatState& state, int lobule) noexcept;
/// What it takes until it is gone, from body temperature [J].
double heat_to_go(const FatModel& model) noexcept;

/// What lobules that are gone had of it: volume [m^3] and mass [kg].
inline double volume_gone(const FatModel& model, const FatState& state) noexcept { return state.gone * model.volume; }
inline double mass_gone(const FatModel& model, const FatState& state) noexcept { return state.gone * model.mass; }

/// What it bears of its strength once coagulated, for who ties lobules to something else.
inline constexpr double kCoagulatedStrength = 0.2;

}  // namespace trocar::tissue
