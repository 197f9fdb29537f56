// The springs of a compiled body as they are where it is drawn, with the rest lengths that gravity gave them: what the
// stiffness matrix is made from, so that both solvers have one material.
#pragma once

#include <vector>

#include <trocar/tissue/network/network.hpp>
#include <trocar/tissue/tets/cuttable.hpp>

namespace trocar::tissue {

std::vector<SpringDescription> drawn_springs(const NetworkModel& model);
std::vector<SpringDescription> drawn_springs(const CuttableModel& model);

/// (own nodes) What they weigh, uncut [kg].
std::vector<double> drawn_masses(const CuttableModel& model);

/// The cells whose volume the body keeps, as corners.
std::vector<std::array<int, 4>> drawn_cells(const NetworkModel& model);
std::vector<std::array<int, 4>> drawn_cells(const CuttableModel& model);

}  // namespace trocar::tissue
