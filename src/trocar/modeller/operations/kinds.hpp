// The operations, a function a file. Private to the folder.
#pragma once

#include <trocar/modeller/operations/operation.hpp>

namespace trocar::modeller {

std::vector<Operation> body_operations();       ///< add, delete, duplicate, rename
std::vector<Operation> key_operations();        ///< set, unset
std::vector<Operation> transform_operations();  ///< move, rotate, scale, mirror
std::vector<Operation> point_operations();      ///< of lines, sections, nets: move, insert, remove
std::vector<Operation> vessel_operations();     ///< trees of vessels
std::vector<Operation> primitive_operations();  ///< balls, cylinders, tubes
std::vector<Operation> spline_operations();     ///< NURBS bodies
std::vector<Operation> file_operations();       ///< bodies from other programs' files
std::vector<Operation> link_operations();       ///< folds and bonds between bodies
std::vector<Operation> paint_operations();      ///< holds, bonds and stiffness by a brush; fibres
std::vector<Operation> place_operations();      ///< the patient's tilt, ports, tools, scope, marks, variation

}  // namespace trocar::modeller
