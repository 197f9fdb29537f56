// Slender bodies (tubes, ligaments, ducts, vessels) as an implicit strand: a chain of n nodes with stretch, bending
// and an elastic foundation, one linearised backward Euler step a tick. Stable at 1 ms whatever the stiffness, where
// an explicit network would need tens of sub-steps.
//
//   stretch     element e: tension EA law(strain), law of [KCM99 eq.5], A = pi (R^2 - r^2) of that element
//   bending     node i: (EI / l^3) |P (x_{i-1} - 2 x_i + x_{i+1} - R_i b_i)|^2 / 2, b_i in the drawn shape, P across
//               the chain; the turns R_i follow from one another without twist along the chain, in the drawn shape and
//               as it is (Bishop frames), from a node that is held; a loose piece takes the spin that suits it best. P
//               and R_i are those at the start of the tick. Torsion has no stiffness of its own.
//   foundation  node i: k_i u (1 + c |u|^2), u = x_i - x0_i: what the sheet that carries the strand does
//   damping     along elements and in bending, stiffness times a time; against space gamma
//   gravity     the drawn shape is the equilibrium: the linear strand's answer to its weight is put into rest lengths,
//               rest bends and rest points, which balance it exactly where it is drawn
// The system matrix keeps only the positive part of the geometric stiffness, so that it is positive definite; it has
// eight diagonals below the main one and is factored by LDL^T in a fixed order. Double precision throughout.
// Our design; discrete bending after the co-rotational rods of the literature [Bergou et al. 08, Hauth & Strasser 04].
//
//   StrandModel model = build(description, 1e-3);
//   StrandState state = rest_state(model);
//   StrandWork work = make_work(model);
//   advance(model, ends, loads, end_reactions, load_reactions, state, work);
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/numerics/vec3.hpp>
#include <trocar/tissue/base/law.hpp>
#include <trocar/tissue/base/report.hpp>

namespace trocar::tissue {

struct StrandDescription {
  std::vector<Vec3d> positions;          ///< drawn centreline, n >= 3 nodes [m]
  std::vector<double> radius;            ///< outer radius per element (n - 1) [m]
  std::vector<double> lumen;             ///< inner radius per element (n - 1) [m]; empty = solid
  double youngs_modulus = 0;             ///< E [Pa]
  SpringLaw law;                         ///< shape factors of [KCM99 eq.5]
  double density = 0;                    ///< of the wall [kg/m^3]
  double lumen_density = 0;              ///< of what fills the lumen [kg/m^3]
  std::vector<double> added_mass;        ///< per node [kg]; empty = none (mass of the sheet that hangs on it)
  std::vector<double> foundation;        ///< per node k_i [N/m]; empty = none
  double foundation_stiffening = 0;      ///< c [1/m^2]
  std::vector<std::uint8_t> prescribed;  ///< per node: 1 = position given every tick; empty = none
  double damping_time = 0;               ///< damping = this x stiffness, for stretch and bending [s]
  double foundation_damping_time = 0;    ///< the same for the foundation [s]
  double global_damping = 0;             ///< gamma [1/s]
  Vec3d gravity{0, 0, 0};                ///< [m/s^2]
  bool prestress = true;                 ///< the drawn shape is the equilibrium under gravity
};

struct StrandModel {
  int nodes = 0;
  double tick = 0;  ///< [s]
  SpringLaw law;
  std::vector<Vec3d> rest;               ///< (n) drawn [m]
  std::vector<double> mass;              ///< (n) [kg]
  std::vector<double> rest_length;       ///< (n - 1) [m]
  std::vector<double> stretch;           ///< (n - 1) EA [N]
  std::vector<double> bend;              ///< (n) EI / l^3 [N/m], 0 at the ends
  std::vector<Vec3d> bend_rest;          ///< (n) b_i [m], in the drawn frame
  std::vector<Vec3d> tangent_rest;       ///< (n) drawn direction of the chain
  std::vector<Vec3d> director_rest;      ///< (n) unit, across it, without twist along the chain
  std::vector<double> foundation;        ///< (n) [N/m]
  std::vector<Vec3d> foundation_point;   ///< (n) x0_i [m]
  double stiffening = 0;                 ///< [1/m^2]
  std::vector<double> radius, lumen;     ///< (n - 1) [m]
  std::vector<std::uint8_t> prescribed;  ///< (n)
  std::vector<int> prescribed_nodes;     ///< ascending; the order of `ends` and `end_reactions`
  double damping_time = 0, foundation_damping_time = 0, gamma = 0;
  Vec3d gravity{0, 0, 0};

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("tick", s.tick), v("law", s.law), v("mass", s.mass), v("rest_length", s.rest_length), v("stretch", s.stretch),
        v("bend", s.bend), v("bend_rest", s.bend_rest), v("tangent_rest", s.tangent_rest),
        v("director_rest", s.director_rest), v("foundation", s.foundation), v("foundation_point", s.foundation_point),
        v("stiffening", s.stiffening), v("prescribed", s.prescribed),
        v("damping_time", s.damping_time, core::kWithNext),
        v("foundation_damping_time", s.foundation_damping_time, core::kWithNext), v("gamma", s.gamma),
        v("gravity", s.gravity), v("nodes", s.nodes, core::kNotHashed), v("rest", s.rest, core::kNotHashed),
        v("radius", s.radius, core::kNotHashed), v("lumen", s.lumen, core::kNotHashed),
        v("prescribed_nodes", s.prescribed_nodes, core::kNotHashed);
  }
};

struct StrandState {
  std::vector<Vec3d> x, v;               ///< (n) [m], [m/s]
  std::vector<double> scale;             ///< (n - 1) stiffness scale of an element: 1 as built, >= 0; a clip > 1
  std::vector<std::uint8_t> alive;       ///< (n - 1) 0 = cut through
  std::vector<double> foundation_scale;  ///< (n) 1 as built, 0 = the sheet is cut there
  std::vector<double> shrunk;  ///< (n - 1) share of its rest length that heat has left of an element; or empty

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("x", s.x), v("v", s.v), v("scale", s.scale), v("alive", s.alive), v("foundation_scale", s.foundation_scale),
        v("shrunk", s.shrunk, core::only_if(!s.shrunk.empty()));
  }
};

struct StrandWork {
  std::vector<double> matrix;    ///< (3n x 9) band, lower; then its factor
  std::vector<double> saved;     ///< (prescribed nodes x 3 x 19) their rows of the matrix before they were prescribed
  std::vector<double> rhs;       ///< (3n) right side, then the new velocities
  std::vector<double> force;     ///< (3 per prescribed node) their right side before they were prescribed [N s]
  std::vector<double> columns;   ///< (3n x 3) for the tangent at one of them
  std::vector<Vec3d> direction;  ///< (n) of the chain at its inner nodes
  std::vector<Vec3d> bend_now;   ///< (n) R_i b_i

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("matrix", s.matrix), v("saved", s.saved), v("rhs", s.rhs), v("force", s.force), v("columns", s.columns),
        v("direction", s.direction), v("bend_now", s.bend_now);
  }
};

/// Where a prescribed node is at the end of this tick.
struct StrandEnd {
  Vec3d x{0, 0, 0};                ///< [m]
  Vec3d v{0, 0, 0};                ///< [m/s]
  bool turned = false;             ///< the holder says how it has turned since the strand was drawn
  Mat3d turn = Mat3d::identity();  ///< that rotation; used at the first prescribed node of a connected piece, so that
                                   ///< a bent strand follows its holder's spin
};

/// A force at the point (1 - w) x_e + w x_{e+1} during one tick, implicit: f0 - k P (x - x0) - d P v, P as in NodeLoad.
struct StrandLoad {
  int element = 0;
  double w = 0;        ///< [0, 1]
  Vec3d f0{0, 0, 0};   ///< [N]
  double k = 0;        ///< [N/m]
  Vec3d x0{0, 0, 0};   ///< [m]
  Vec3d dir{0, 0, 0};  ///< zero, or unit
  double d = 0;        ///< [N s/m]
};

/// What the strand does to what holds its prescribed node.
struct StrandReaction {
  Vec3d force{0, 0, 0};  ///< force the strand exerts on its holder [N]
  Mat3d tangent;         ///< how that force falls as the holder moves: -d force / d x [N/m], the rest of the strand
                         ///< following within this tick (inertia over the tick included)
};

/// How far the points that the foundation pulls to have gone from where they were drawn, when this tick ends [m], and
/// how fast they go [m/s].
struct StrandGround {
  Vec3d x{0, 0, 0}, v{0, 0, 0};
};

/// Compiles a strand. Throws std::invalid_argument saying what is unsound.
StrandModel build(const StrandDescription& description, double tick);
StrandState rest_state(const StrandModel& model);
StrandWork make_work(const StrandModel& model);

/// One tick.
/// @param ends            one per prescribed node, in order; empty = they stay where they are
/// @param loads           any order, any number per element
/// @param end_reactions   (prescribed nodes) or empty
/// @param load_reactions  (loads) or empty: force each load exerted on the strand [N]
/// @param ground          what its foundation stands on
StepReport advance(const StrandModel& model, std::span<const StrandEnd> ends, std::span<const StrandLoad> loads,
                   std::span<StrandReaction> end_reactions, std::span<Vec3d> load_reactions, StrandState& state,
                   StrandWork& work, const StrandGround& ground = {}) noexcept;

/// Cut through element e: no stretch across it and no bending that crosses it.
void cut_element(StrandState& state, int element) noexcept;
/// e/l of element e [-]; 0 where cut.
double element_strain(const StrandModel& model, const StrandState& state, int element) noexcept;

struct StrandEnergy {
  double kinetic = 0, stretch = 0, bending = 0, foundation = 0, gravity = 0;
  double total() const { return kinetic + stretch + bending + foundation + gravity; }
};
/// For tests and reports (allocates). Bends are turned as without `StrandEnd::turn`.
StrandEnergy energy(const StrandModel& model, const StrandState& state);

void add_to_hash(core::Hasher& hasher, const StrandState& state) noexcept;
void add_to_hash(core::Hasher& hasher, const StrandModel& model) noexcept;

}  // namespace trocar::tissue
