// Is a compliance that comes from a file that of this body? A file's checksum needs no key, so that it says nothing of
// who wrote it.
#pragma once

#include <span>
#include <string>

#include <trocar/tissue/elastostatic/stiffness.hpp>

namespace trocar::tissue {

/// All figures are finite; the matrix is symmetric, positive on its diagonal, zero on held axes; and under forces of 1
/// N on every kept node and axis, in directions that follow from the content, it displaces the kept nodes as a solution
/// of K u = f does, and likewise the fields under their loads. That sum takes every column into account, where a unit
/// force would look at one.
/// @param columns  (3 kept x 3 kept) [m/N], @param fields (loads x 3 kept) [m], @param loads (loads x 3 nodes) [N]: as
///                 condense() takes and gives them, rounded to floats
/// @return what is wrong; empty: nothing
/// @throws NotHeld as condense()
std::string fault_of_compliance(const Stiffness& k, std::span<const int> kept, std::span<const double> loads,
                                std::span<const float> columns, std::span<const float> fields);

}  // namespace trocar::tissue
