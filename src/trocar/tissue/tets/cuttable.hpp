// A body of tetrahedra that can be cut while it lives: springs along the edges of its cells and across their faces
// (tet_springs.hpp), cut by parting cells along faces (geometry/tets/tet_cut.hpp). What a cut changes is State: where
// nodes are drawn, which corners and neighbours cells have, how many nodes there are. The arrays that the kernel reads
// follow from that alone; they are Work, made again after every cut.
//
// What every cell brings to its springs is known from the start, so nothing is fitted while running: a spring along an
// edge has the sum of what the cells around that edge bring, on either side of a cut its own; one across a face is gone
// when its face has parted. Mass is density times the drawn volume, always. Where a snap leaves a node that the time
// step cannot bear, the springs there are softened, on both their ends.
//
//   const CuttableModel model = build(description, 1e-3);
//   CuttableState state = rest_state(model);
//   CuttableWork work = make_work(model);
//   advance(model, loads, reactions, state, work);            // 1 ms
//   geometry::CutResult book = cut(model, blade, state, work);
// Cells that collapse are pushed open as those of a network are (guard.hpp), piece by piece.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/geometry/tets/tet_cut.hpp>
#include <trocar/tissue/network/network.hpp>
#include <trocar/tissue/network/prestress.hpp>
#include <trocar/tissue/network/stiffness_field.hpp>
#include <trocar/tissue/network/volume_force.hpp>
#include <trocar/tissue/tets/tet_springs.hpp>

namespace trocar::tissue {

struct CuttableDescription {
  std::vector<Vec3d> points;         ///< drawn [m]
  std::vector<geometry::Tet> cells;  ///< positive volume
  TetMaterial material;
  std::vector<Vec3d> fibres;        ///< per cell, or empty
  StiffnessField stiffness;         ///< where it is not what the material says
  std::vector<std::uint8_t> fixed;  ///< per point, Held bits, or empty
  std::vector<Anchor> anchors;      ///< what hangs it in space; build() writes their rest points
  Vec3d gravity{0, 0, 0};           ///< [m/s^2]
  double global_damping = 0;        ///< against space [1/s]
  int spare_nodes = 1024;           ///< how many nodes cuts may double
};

/// What a cell brings to its springs: k l^2 [N m], and their rest length over the drawn one. Edges as in kCellEdges.
struct CellSprings {
  float edge[6], edge_ratio[6];
  float cross[4], cross_ratio[4];  ///< across the face opposite to a corner: this cell's half

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("edge", s.edge), v("edge_ratio", s.edge_ratio), v("cross", s.cross), v("cross_ratio", s.cross_ratio);
  }
};
inline constexpr int kFreeColumns = 4;  ///< of a slice of rows, for springs that a cut adds
inline constexpr int kCellEdges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

struct CuttableModel {
  geometry::CuttableTets drawn;     ///< uncut, with room for spare nodes
  std::vector<CellSprings> brings;  ///< (cells)
  std::vector<std::uint8_t> fixed;  ///< (capacity) of the node it was made from
  std::vector<int> row_of_node;     ///< (capacity)
  std::vector<Anchor> anchors;
  int own_nodes = 0, own_rows = 0;  ///< without the spare ones
  int rows = 0;                     ///< capacity
  int packs = 0;                    ///< capacity
  int widest = 0;                   ///< most springs of a node, uncut
  Vec3d origin, gravity;
  double density = 0, damping_time = 0, gamma = 0;
  float p1 = 0, p2 = 0, cap = 1, cap_slope = 1;
  Bulk bulk;                              ///< the volume force; its impulses divide the sub-steps
  double tick = 0, dt = 0, dt_limit = 0;  ///< [s]
  float opening = kOpeningTime;           ///< within which a collapsed cell is driven open [s]
  int substeps = 1;
  double misfit = 0, residual = 0;  ///< of the springs' fit; of the drawn shape under gravity [N]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("drawn", s.drawn), v("brings", s.brings), v("fixed", s.fixed), v("row_of_node", s.row_of_node),
        v("anchors", s.anchors), v("own_nodes", s.own_nodes), v("own_rows", s.own_rows), v("rows", s.rows),
        v("packs", s.packs), v("widest", s.widest), v("substeps", s.substeps), v("origin", s.origin),
        v("gravity", s.gravity), v("density", s.density), v("damping_time", s.damping_time), v("gamma", s.gamma),
        v("tick", s.tick), v("dt", s.dt), v("bulk", s.bulk), v("p1", s.p1), v("p2", s.p2), v("cap", s.cap),
        v("cap_slope", s.cap_slope), v("opening", s.opening), v("dt_limit", s.dt_limit, core::kNotHashed),
        v("misfit", s.misfit, core::kNotHashed), v("residual", s.residual, core::kNotHashed);
  }
};

struct CuttableState {
  std::vector<NodeState> nodes;  ///< (rows)
  geometry::CuttableTets tets;
  std::uint64_t version = 0;            ///< of tets: a hash of what cuts made of them, 0 while uncut
  double volume = 0;                    ///< change of the drawn volume so far [m^3]
  std::vector<std::uint8_t> tet_phase;  ///< (cells) as GuardState::phase
  std::uint32_t open_tets = 0;          ///< cells being pushed open
  std::uint32_t tick = 0;               ///< ticks made

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("nodes", s.nodes), v("tets", s.tets), v("version", s.version), v("volume", s.volume), v("tet_phase", s.tet_phase),
        v("open_tets", s.open_tets), v("tick", s.tick);
  }
};

/// Scratch.
struct CuttableWork {
  std::uint64_t made_for = ~0ull;  ///< State::version that the arrays below are for
  std::vector<NodeState> other;
  std::vector<HalfEdgePack> packs;
  std::vector<RowPack> row_packs;
  std::vector<int> slice_begin;
  std::vector<int> slice_end;  ///< of the columns in use: those that wait for cuts cost nothing
  int slices = 0;
  std::vector<double> mass;           ///< (capacity) [kg]
  std::vector<std::uint8_t> changed;  ///< (capacity) by the last cut
  std::vector<float> bearable;        ///< (capacity) share of its stiffness that the time step bears
  std::vector<std::uint8_t> fixed;    ///< (capacity)
  std::vector<int> begin, around;     ///< cells at each node
  std::vector<int> node_of_row;       ///< (rows) -1: none
  std::vector<Vec3d> now;             ///< (capacity)
  std::vector<TetRest> guarded;       ///< (cells)
  std::vector<TetPack> guarded_packs;
  std::vector<std::int32_t> part;    ///< (capacity) pieces that hang together by nodes, in the order of these
  std::int32_t parts = 1;            ///< how many
  std::int32_t largest_part = 0;     ///< the one with the most nodes
  std::vector<int> open_tets;        ///< (cells)
  std::vector<std::uint8_t> folded;  ///< (rows)
  std::vector<std::uint16_t> below;  ///< (packs of cells)
  std::vector<LoadedNode> loaded;    ///< (capacity)
  VolumeCells volume_cells;          ///< empty where there is no volume force
  VolumeWork volume;                 ///< the same
  geometry::CutWork cut;
  ScarWork scars;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("made_for", s.made_for), v("other", s.other), v("packs", s.packs), v("row_packs", s.row_packs),
        v("slice_begin", s.slice_begin), v("slice_end", s.slice_end), v("slices", s.slices), v("mass", s.mass),
        v("changed", s.changed), v("bearable", s.bearable), v("fixed", s.fixed), v("begin", s.begin),
        v("around", s.around), v("node_of_row", s.node_of_row), v("now", s.now), v("guarded", s.guarded),
        v("guarded_packs", s.guarded_packs), v("part", s.part), v("parts", s.parts), v("largest_part", s.largest_part),
        v("open_tets", s.open_tets), v("folded", s.folded), v("below", s.below), v("loaded", s.loaded),
        v("volume_cells", s.volume_cells), v("volume", s.volume), v("cut", s.cut), v("scars", s.scars);
  }
};

/// Throws std::invalid_argument naming what is unsound, and where gravity cannot be borne.
CuttableModel build(const CuttableDescription& description, double tick);
CuttableState rest_state(const CuttableModel& model);
CuttableWork make_work(const CuttableModel& model);

/// What CuttableState::version is of these cells.
std::uint64_t version_of(const CuttableModel& model, const geometry::CuttableTets& tets) noexcept;

/// One tick; loads and reactions as for a network. Nodes are numbered as described, doubles after them.
StepReport advance(const CuttableModel& model, std::span<const NodeLoad> loads, std::span<Vec3f> reactions,
                   CuttableState& state, CuttableWork& work, Hands hands = Hands::off,
                   std::span<const ScarredSpring> scars = {}) noexcept;

/// Makes the scratch what the State says, where it is not: `part` and `parts` may then be asked. advance() and cut() do
/// so themselves.
void make_current(const CuttableModel& model, const CuttableState& state, CuttableWork& work) noexcept;

/// Parts the body where the blade is now (world frame).
geometry::CutResult cut(const CuttableModel& model, const geometry::Blade& blade, CuttableState& state,
                        CuttableWork& work) noexcept;

inline NodeView view_of(const CuttableModel& model, const CuttableState& state) noexcept {
  return {state.nodes, model.row_of_node, model.origin};
}
Vec3d position(const CuttableModel& model, const CuttableState& state, int node) noexcept;
Vec3d velocity(const CuttableModel& model, const CuttableState& state, int node) noexcept;
void set_position(const CuttableModel& model, CuttableState& state, int node, Vec3d x) noexcept;
void set_velocity(const CuttableModel& model, CuttableState& state, int node, Vec3d v) noexcept;
/// As folded_rows of a network.
std::span<const std::uint8_t> folded_rows(const CuttableModel& model, const CuttableState& state,
                                          CuttableWork& work) noexcept;
/// Drawn mass of a node [kg], from its cells.
double mass_of(const CuttableModel& model, const CuttableState& state, int node) noexcept;

void add_to_hash(core::Hasher& hasher, const CuttableState& state) noexcept;
/// Of everything that a tick and a cut read.
void add_to_hash(core::Hasher& hasher, const CuttableModel& model) noexcept;

}  // namespace trocar::tissue
