// A thin sheet with stretch and bending: a grid of nodes between two borders (a fold of peritoneum, a mesosalpinx), or
// a closed surface of triangles (the wall of a gallbladder) that may enclose something under pressure (enclosure.hpp).
//
//   stretch   springs along the grid's lines and along both diagonals of each cell, in the network of network.hpp, so
//             that a sheet of rectangular cells has exactly E t and nu = 1/3. [Van Gelder 98] gives springs from
//             triangles; on the two triangles of a square that would be 20 % too stiff and not isotropic, hence
//             the second diagonal. A closed surface has springs along its triangles' sides, 3/4 E t cot(angle facing
//             the side) from either triangle: exact for equal tension in all directions, and altogether where
//             triangles are even. Stiffness follows the polynomial law [KCM99 eq.5].
//   bending   that of a thin plate, D/2 (nu |x_uu + x_vv|^2 + (1 - nu) (|x_uu|^2 + |x_vv|^2 + 2 |x_uv|^2)) per area
//   with
//             D = E t^3 / 12 (1 - nu^2), by differences of positions along the grid's lines (as vectors: for a sheet
//             that bends without stretching this is Kirchhoff's energy, whichever way it is turned [cf. Wardetzky et
//             al. 07]). Constant matrices, so it conserves both momenta and its step has a bound. The sheet is flat by
//             nature. Exact for rectangular cells; skew ones are taken as rectangular. On a closed surface
//             D/2 |laplacian x|^2 per area, a square for every edge and its two triangles [Bergou et al. 06]: of the
//             same plate, as Gauss's curvature has the same integral however a closed surface is bent.
//   pressure  of what is enclosed: impulses with bending's, implicit in the volume (enclosure.hpp)
//   weight    density x thickness x area; nodes of small cells (and of corners) are given half the mean mass
//   time      explicit: bending as impulses once or a few times a tick, stretch in the network's own sub-steps
// Held nodes (the borders) go in a straight line to where their holders are when the tick ends; border_pulls() says
// what the sheet does to the holders. With `settle` the sheet is first let hang from its borders: what is then drawn is
// its equilibrium under gravity.
//
//   MembraneModel model = build(description, 1e-3);
//   MembraneState state = rest_state(model);
//   MembraneWork work = make_work(model);
//   border_pulls(model, state, work, pulls);             // for the holders
//   advance(model, targets, loads, reactions, state, work);
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/tissue/base/law.hpp>
#include <trocar/tissue/membrane/enclosure.hpp>
#include <trocar/tissue/network/network.hpp>
#include <trocar/tissue/network/stiffness_field.hpp>

namespace trocar::tissue {

inline constexpr double kSheetPoisson = 1.0 / 3.0;  ///< of a plane net of springs

struct MembraneDescription {
  int columns = 0, rows = 0;     ///< nodes along a border, and from border to border; each >= 2; 0: triangles
  std::vector<Vec3d> positions;  ///< (columns x rows) drawn [m]; node = row * columns + column
  /// Instead of a grid: a closed surface, counter-clockwise seen from outside.
  std::vector<std::array<int, 3>> triangles;
  Enclosure enclosure;              ///< what a closed surface has inside
  std::vector<std::uint8_t> held;   ///< per node: 1 = position given every tick; empty = none
  double thickness = 0;             ///< t [m]
  double youngs_modulus = 0;        ///< E [Pa]
  StiffnessField stiffness;         ///< times E, where that is not the same everywhere
  SpringLaw law;                    ///< shape factors of [KCM99 eq.5]
  double density = 0;               ///< [kg/m^3]
  double damping_time = 0;          ///< damping = this x stiffness, stretch [s]; a floor keeps bending steps in check
  double bending_damping_time = 0;  ///< the same for bending [s]
  double global_damping = 0;        ///< gamma [1/s]
  Vec3d gravity{0, 0, 0};           ///< [m/s^2]
  bool settle = true;               ///< let it hang before it is drawn
};

/// One square of the bending energy: k |sum_j c[j] x[node[j]]|^2 / 2.
struct BendStencil {
  std::int32_t count = 0;
  std::array<std::int32_t, 5> node{};  ///< the middle, or the first corner of a cell, first
  std::array<float, 5> c{};            ///< difference weights [1/m^2]
  float k = 0;                         ///< share of D x area [N m^3]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("count", s.count), v("node", s.node), v("c", s.c), v("k", s.k);
  }
};

/// A spring at a held node.
struct BorderSpring {
  std::int32_t spring = 0, other = 0;
  double stiffness = 0;  ///< k l [N]
  double rest = 0;       ///< l [m]
  double damping = 0;    ///< [N s/m]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("spring", s.spring), v("other", s.other), v("stiffness", s.stiffness), v("rest", s.rest), v("damping", s.damping);
  }
};

/// Const after build().
struct MembraneModel {
  int columns = 0, rows = 0;
  NetworkModel network;  ///< its tick is one bending step
  SpringLaw law;
  Enclosure enclosure;                        ///< of a closed surface; its volume is that of the drawn shape
  std::vector<double> contents;               ///< (nodes) mass of what is enclosed, as inertia [kg]; or empty
  double tick = 0;                            ///< [s]
  int bend_steps = 1;                         ///< in a tick, of bending and pressure
  double bend_limit = 0;                      ///< longest sufficient bending step [s]
  std::vector<std::array<int, 3>> triangles;  ///< a grid's: two per cell, diagonals alternating
  std::vector<BendStencil> bends;
  std::vector<int> bend_first;     ///< (bends + 1) into bend_triangle
  std::vector<int> bend_triangle;  ///< the triangles that a stencil bends
  std::vector<int> held_nodes;     ///< ascending; the order of targets and pulls
  std::vector<int> border_first;   ///< (held nodes + 1) into border_spring
  std::vector<BorderSpring> border_spring;
  std::vector<double> border_bending;           ///< (held nodes) bound of the bending stiffness there [N/m]
  double thickness = 0, bending_stiffness = 0;  ///< t [m], D [N m]
  double bending_damping_time = 0, gamma = 0;
  double first_swell = 0;       ///< EnclosureState::expected begins this much above the drawn volume [m^3]
  double settled_residual = 0;  ///< unbalanced force left after it was let hang [N]

  int nodes() const { return network.nodes; }
  bool closed() const { return columns == 0; }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("network", s.network), v("columns", s.columns), v("rows", s.rows), v("law", s.law), v("thickness", s.thickness),
        v("bend_steps", s.bend_steps), v("enclosure", s.enclosure), v("contents", s.contents),
        v("first_swell", s.first_swell), v("bend_first", s.bend_first), v("bend_triangle", s.bend_triangle),
        v("bends", s.bends), v("held_nodes", s.held_nodes), v("border_first", s.border_first),
        v("border_spring", s.border_spring), v("border_bending", s.border_bending), v("tick", s.tick, core::kWithNext),
        v("bending_damping_time", s.bending_damping_time, core::kWithNext), v("gamma", s.gamma),
        v("bend_limit", s.bend_limit, core::kNotHashed), v("triangles", s.triangles, core::kNotHashed),
        v("bending_stiffness", s.bending_stiffness, core::kNotHashed),
        v("settled_residual", s.settled_residual, core::kNotHashed);
  }
};

struct MembraneState {
  NetworkState network;
  EnclosureState enclosure;
  std::vector<std::uint8_t> torn;  ///< (bends) 1 = a cut passes through its triangles

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("network", s.network), v("torn", s.torn), v("enclosure", s.enclosure);
  }
};

/// A sum of forces on one row of the network [N], as registers hold it.
struct alignas(16) RowForce {
  double x = 0, y = 0, z = 0, zero = 0;
};

struct MembraneWork {
  NetworkWork network;
  std::vector<RowForce> force;  ///< (rows) of bending [N]
  std::vector<Vec3d> place;     ///< (nodes) of a closed surface [m]
  std::vector<Vec3d> gradient;  ///< (nodes) of the enclosed volume [m^2]
  std::vector<Vec3d> weight;    ///< (nodes) of what is enclosed, where it presses [N]
  std::vector<Vec3f> reaction;  ///< of one bending step, as many as loads may come

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("network", s.network), v("force", s.force), v("place", s.place), v("gradient", s.gradient), v("weight", s.weight),
        v("reaction", s.reaction);
  }
};

/// What the sheet does to what holds a border node.
struct BorderPull {
  Vec3d force{0, 0, 0};  ///< on the holder [N]
  double k = 0;          ///< bound of the border node's own stiffness, the rest of the sheet standing still [N/m]
  double d = 0;          ///< and of its damping [N s/m]
};

/// Compiles a sheet. Throws std::invalid_argument saying what is unsound.
MembraneModel build(const MembraneDescription& description, double tick);

/// A sheet that was let hang with some more of its nodes held, which are free in the model: bonds tie them.
struct TiedMembrane {
  MembraneModel model;
  std::vector<Vec3d> pull;  ///< (tied nodes, ascending) what the drawn sheet asks of who ties them, on them [N]
};
/// @param tied  per node: 1 = held while it settles, free afterwards
TiedMembrane build_tied(const MembraneDescription& description, std::span<const std::uint8_t> tied, double tick);

/// Its masses and springs, not yet damped: for linear solves.
NetworkDescription network_of(const MembraneDescription& description);
MembraneState rest_state(const MembraneModel& model);
/// @param loads  the most loads that advance() will be given
MembraneWork make_work(const MembraneModel& model, std::size_t loads = 0);

/// @param pulls  (held nodes)
void border_pulls(const MembraneModel& model, const MembraneState& state, MembraneWork& work,
                  std::span<BorderPull> pulls) noexcept;

/// One tick.
/// @param targets    (held nodes) where they are when the tick ends, or empty: they stay
/// @param loads      sorted by node, as for a network
/// @param reactions  (loads) or empty: mean force that each load exerted on its node [N]
/// @param scars      springs that heat has changed
StepReport advance(const MembraneModel& model, std::span<const Vec3d> targets, std::span<const NodeLoad> loads,
                   std::span<Vec3f> reactions, MembraneState& state, MembraneWork& work,
                   std::span<const ScarredSpring> scars = {}) noexcept;

/// After springs were cut: bending across torn triangles ends, and what is enclosed runs out.
/// @param parted (triangles) 1 = cut open
void tear_bends(const MembraneModel& model, std::span<const std::uint8_t> parted, MembraneState& state) noexcept;

struct MembraneEnergy {
  double kinetic = 0, stretch = 0, bending = 0, gravity = 0;
  double pressure = 0;  ///< of what is enclosed, as long as it is tight; without its weight
  double total() const { return kinetic + stretch + bending + gravity + pressure; }
};
MembraneEnergy energy(const MembraneModel& model, const MembraneState& state);
/// Of a closed surface as it is now [m^3].
EnclosedVolume enclosed_volume(const MembraneModel& model, const MembraneState& state);

void add_to_hash(core::Hasher& hasher, const MembraneState& state) noexcept;
void add_to_hash(core::Hasher& hasher, const MembraneModel& model) noexcept;

}  // namespace trocar::tissue
