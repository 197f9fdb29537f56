// Moving, turning and scaling by hand: a key begins it, the pointer leads, an axis may be chosen and a number typed,
// Enter or a click keeps it, Esc or the right button takes it back. As in other editors of shapes.
#pragma once

#include <optional>
#include <string>

#include <trocar/numerics/vec3.hpp>

namespace trocar::app {

struct Gesture {
  enum class Kind { move, rotate, scale } kind = Kind::move;
  std::string thing;                ///< what is changed as a whole, or whose point
  std::string list;                 ///< of a point: its list
  std::optional<std::size_t> item;  ///< of a point
  int axis = -1;                    ///< 0, 1, 2: along x, y, z only
  std::string typed;                ///< a number in mm, degrees or as a factor
  Vec3d about;                      ///< [m] the middle
  float from_x = 0, from_y = 0;     ///< [px] where the pointer was
  bool dragged = false;             ///< by a button that is held, and ends with it

  /// What was typed, if it is a number.
  std::optional<double> number() const;
  /// A line that says what is being done.
  std::string said(const std::string& amount) const;
};

}  // namespace trocar::app
