// Where a tube's fimbriae are: how they hang, and which ovary they lie on.
#pragma once

#include <trocar/sim/model/model.hpp>
#include <trocar/view/base/strand_curve.hpp>
#include <trocar/view/bodies/fimbria.hpp>

namespace trocar::view {

/// @param end  frame of the strand's end at rest
FimbriaSite fimbria_site(const sim::Model& model, int strand, const CurveFrame& end);

}  // namespace trocar::view
