// The arguments of a fact or an event as a file gives them, by their parameters' names.
#pragma once

#include <span>

#include <trocar/training/facts/argument.hpp>
#include <trocar/training/rules/names.hpp>

namespace trocar::training {

/// One argument a parameter, in their order; of other keys of `object` it says nothing. Missing ones, wrong units,
/// names that the scene has not are faults.
/// @param what  whose arguments they are, for people: "clips.first_set"
Arguments read_arguments(const scene::JsonValue& object, std::span<const Parameter> parameters, std::string_view what,
                         const RuleReading& reading);

}  // namespace trocar::training
