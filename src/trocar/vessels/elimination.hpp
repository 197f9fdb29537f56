// Exact elimination of sparse systems whose graph is nearly a tree, as pressures in vessels are: leaves first, so a
// tree fills nothing in (2 n multiplications and n divisions), and every cycle costs a little more. Which entries there
// will be is worked out once; the numbers may then change at every tick. No pivots are exchanged: made for matrices
// that are dominant by columns, as those of conserved quantities are. Fixed order, no allocation.
//
//   const Elimination e = plan_elimination(nodes, links);  // rows are renumbered: row_of[node]
//   std::fill(values...); values[e.entry_of_link[l]] = A(row a, row b), values[e.entry_of_link[l] ^ 1] = A(row b, row
//   a) if (eliminate(e, diagonal, values, rhs) < 0) ...       // rhs is the solution, the others are used up
//
// Minimum degree; among nodes of the same degree those come first whose neighbours were eliminated longest ago, so that
// consecutive rows do not wait for each other [George & Liu 1989, The evolution of the minimum degree ordering].
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <trocar/core/fields.hpp>

namespace trocar::vessels {

struct Elimination {
  int rows = 0;
  std::vector<int> row_of;  ///< (nodes)
  std::vector<int> start;   ///< (rows + 1) row i's later neighbours are later[start[i]] .. later[start[i + 1]]
  std::vector<int> later;   ///< their rows, ascending; entry k: A(i, j) at values[2 k], A(j, i) at values[2 k + 1]
  std::vector<int> fill;    ///< for rows with several later neighbours x, y in turn: where A(x, y) stands
  std::vector<int> entry_of_link;  ///< (links) where A(row of a, row of b) stands; ^ 1: the other way round
  std::size_t values() const { return 2 * later.size(); }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("row_of", s.row_of), v("later", s.later), v("rows", s.rows, core::kNotHashed),
        v("start", s.start, core::kNotHashed), v("fill", s.fill, core::kNotHashed),
        v("entry_of_link", s.entry_of_link, core::kNotHashed);
  }
};

/// Several links may join the same two nodes (they share an entry).
/// Throws std::length_error when more than `max_entries` would be filled in.
Elimination plan_elimination(int nodes, std::span<const std::pair<int, int>> links, std::size_t max_entries);

/// Solves A x = b: b in `rhs` becomes x. @return -1, or the first row whose pivot is not > 0 (rhs is garbage then)
int eliminate(const Elimination& e, std::span<double> diagonal, std::span<double> values,
              std::span<double> rhs) noexcept;

}  // namespace trocar::vessels
