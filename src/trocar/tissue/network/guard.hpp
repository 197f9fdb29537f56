// What keeps a body of springs a body, whatever is done to it: cells that collapse are pushed open, because their
// mirror image would satisfy all springs; nodes that leap to and fro are caught; ends that flap are calmed. The same
// for lattices and for tetrahedra that can be cut. It costs a look at a quarter of the cells a tick where nothing has
// collapsed.
//
//   Guard guard(body, state, scratch, nodes, hands);  // once a tick: what has collapsed?
//   guard.mend(in, out);                              // after each sub-step: cells open, ends calm
//   guard.catch_leaps(in, out);                       // after that and its loads
//   guard.release(nodes);                             // when the tick is done
//
// Private to the folder. docs/developers/robustness.md says what was tried and what it withstands.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <trocar/core/fields.hpp>
#include <trocar/numerics/mat3.hpp>
#include <trocar/numerics/vec3.hpp>
#include <trocar/tissue/network/network_layout.hpp>

namespace trocar::tissue {

/// A protected cell.
struct TetRest {
  int row[4];
  float rest6;  ///< six times its volume in the drawn shape [m^3]

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("row", s.row), v("rest6", s.rest6);
  }
};
inline constexpr double kCollapsed = 0.1;     ///< share of the rest volume below which a cell is pushed open
inline constexpr float kOpeningTime = 1e-3f;  ///< with which it takes its shape again, at least [s]

/// Puts a cell into a lane of a pack. @param limit6  six-fold volume below which it has collapsed [m^3]
inline void put_cell(const TetRest& cell, double limit6, int lane, TetPack& pack) noexcept {
  for (int i = 0; i < 4; ++i) pack.offset[i][lane] = std::uint32_t(cell.row[i]) * std::uint32_t(sizeof(NodeState));
  pack.limit6[lane] = float(limit6);
}
/// A pack whose lanes are empty: no cell there ever collapses.
TetPack empty_pack() noexcept;

/// What the guard reads of a body.
struct GuardedBody {
  std::span<const TetRest> cells;
  std::span<const TetPack> packs;      ///< the same, for the search
  std::span<const int> row_of_node;    ///< (nodes or more)
  std::span<const int> node_of_row;    ///< (rows), -1 = none
  std::span<const double> mass;        ///< (nodes or more) [kg]
  std::span<const Vec3d> rest;         ///< (nodes or more) drawn places [m]
  std::span<const RowPack> row_packs;  ///< held axes have no weight
  std::span<const std::int32_t> part;  ///< (nodes or more) which piece a node belongs to; empty: there is one
  int nodes = 0, rows = 0;
  Vec3d origin;
  double dt = 0;                 ///< of a sub-step [s]
  bool uncut = true;             ///< nothing of it has been cut or has torn
  float opening = kOpeningTime;  ///< twice a wave's time across a cell, but no less than kOpeningTime [s]
};

/// The parts of a body's State that are the guard's.
struct GuardState {
  std::span<std::uint8_t> phase;  ///< (cells) 0 idle, 1..kOldestFold being pushed open, kGone
  std::uint32_t& open;            ///< cells being pushed open
  std::uint32_t tick;
};
struct GuardScratch {
  std::span<int> open;             ///< (cells)
  std::span<std::uint16_t> below;  ///< (packs)
};

/// Marks the rows of cells that have been folded for long: where they are says nothing about where the body is, as they
/// may lie behind other tissue.
/// @param folded  (rows) @return it, or nothing where no cell is
std::span<const std::uint8_t> mark_folded(std::span<const TetRest> cells, std::span<const std::uint8_t> phase,
                                          std::span<std::uint8_t> folded) noexcept;

/// Whether an instrument touches or holds the body. Folded cells are driven home only where none does: a drive that
/// takes no account of springs, against hands that keep the cells folded, is an engine without a limit.
enum class Hands { off, on };

class Guard {
 public:
  Guard(const GuardedBody& body, const GuardState& state, const GuardScratch& scratch, std::span<const NodeState> nodes,
        Hands hands) noexcept;

  bool at_work() const noexcept { return !m_open.empty(); }
  /// `in` is where the sub-step began, `out` what it has made of it.
  void mend(const NodeState* in, NodeState* out) const noexcept;
  /// The same, once loads have been applied.
  void catch_leaps(const NodeState* in, NodeState* out) const noexcept;
  /// Lets go the cells that are open, and counts for how long the others have been folded.
  void release(std::span<const NodeState> nodes) noexcept;

 private:
  static constexpr int kMostLeaps = 64;  // caught in one tick, the lowest rows first
  static constexpr int kMostParts = 16;  // pieces whose cells are pushed open; small ones beyond are left as they are

  void find_collapsed(std::span<const NodeState> nodes) noexcept;
  void list_open() noexcept;
  void list_fast(std::span<const NodeState> nodes) noexcept;
  void take_turns(std::span<const NodeState> nodes) noexcept;
  Mat3d turn_of(std::int32_t part, std::span<const NodeState> nodes) const noexcept;
  Vec3f drift(std::span<const NodeState> nodes) const noexcept;
  void push_open(const NodeState* in, NodeState* out) const noexcept;
  void calm(const NodeState* in, NodeState* out) const noexcept;
  bool late() const noexcept { return (m_state.tick & 255u) >= 192; }
  bool unfolds_now() const noexcept { return late() && m_hands == Hands::off; }
  std::int32_t part_of(int cell) const noexcept;
  Vec3f row_weight(int row) const noexcept;
  Vec3d place_of(int node, std::span<const NodeState> nodes) const noexcept;

  const GuardedBody& b;
  GuardState m_state;
  GuardScratch m_scratch;
  std::span<const int> m_open;
  std::array<Mat3d, kMostParts> m_turn;  // of those parts that have an open cell
  std::array<int, kMostLeaps> m_fast;
  int m_fast_count = 0;
  bool m_calms = false;
  Hands m_hands;
  Vec3f m_drift{};
};

}  // namespace trocar::tissue
