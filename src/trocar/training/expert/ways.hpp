// A part of a plan can be done in many ways: as it is written, or by a hand that draws somewhat farther, holds deeper,
// carries to beside. What decides whether it comes off lies in hundredths of a millimetre that no plan foresees, so a
// demonstration is rehearsed (attempt/rehearsal.hpp), and its exercise's file says which way each part went well in.
#pragma once

#include <vector>

#include <trocar/training/expert/plan.hpp>

namespace trocar::training {

/// The ways of a plan's parts, in their order; those that are missing are 0.
using Ways = std::vector<int>;

/// Is there anything in it that a hand can do otherwise?
bool has_ways(PlanPart part);

/// The part as it is done in that way, from the part as it is written. Where to, how far, how deep and how hard change,
/// never what is done, and nothing that the exercise judges by.
/// @param way  0: as it is written; the others are drawn from it and `place`, which tells the plan's parts apart
void do_in_way(PlanPart& part, int way, std::uint64_t place);

}  // namespace trocar::training
