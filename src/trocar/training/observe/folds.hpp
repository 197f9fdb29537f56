// How a fold hangs between its two borders, column by column of its grid, for dividing it from the strand that
// it carries.
#pragma once

#include <vector>

#include <trocar/sim/model/state.hpp>

namespace trocar::training {

/// The columns of a fold between a strand and its root. A column is whole while every spring along it is.
class FoldColumns {
 public:
  FoldColumns() = default;
  FoldColumns(const sim::Model& model, int membrane);

  int count() const { return int(m_s.size()); }
  double s(int column) const { return m_s[size_t(column)]; }  ///< where it begins on the strand [m]
  bool whole(const sim::Model& model, const sim::State& state, int column) const;
  /// Its point that lies so far from the strand's surface, in the drawn shape [m].
  Vec3d point(const sim::Model& model, const sim::State& state, int column, double away) const;
  /// Length of the border between two places of the strand along which it is whole [m].
  double whole_between(const sim::Model& model, const sim::State& state, double from, double to) const;

  /// Is that a fold that hangs on a strand?
  static bool there(const sim::Model& model, BodyId body);

 private:
  int m_membrane = -1, m_rows = 0;
  std::vector<double> m_s;
  std::vector<int> m_springs;  ///< (columns x (rows - 1)) from row to row
};

}  // namespace trocar::training
