// A dimension as a file writes it: a number, or a text like "crank", "-0.5 * crank + 3", "rod - crank": multiples of
// the mechanism's parameters, added up. Numbers are in the unit of the key.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <trocar/kinematics/chains/description.hpp>

namespace trocar::scene {

struct QuantityReading {
  kinematics::Quantity quantity;
  std::string fault;  ///< empty, or "expected ..., got ..."
};

/// @param measure  what it must be: parameters of other measures are a fault
/// @param unit     SI value of 1 in the file; of a ratio also what its parameters are multiplied with
QuantityReading read_quantity(std::string_view text, const std::vector<kinematics::Parameter>& parameters,
                              kinematics::Measure measure, double unit);

/// Its value with the parameters as they are.
double value_of(const kinematics::Quantity& quantity, const std::vector<kinematics::Parameter>& parameters);

}  // namespace trocar::scene
