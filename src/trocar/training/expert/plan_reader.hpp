// The demonstration of an exercise's file as a plan.
#pragma once

#include <trocar/training/expert/plan.hpp>

namespace trocar::training {

/// A list of goals, and of parts with goals:
///   {"goal": "survey", "until": CONDITION, "tries": 1, "do": [SKILL, ...], "if_failed": [SKILL, ...], "every": 3}
///   {"for_each": "side", "at_most_s": 240, "pause_s": 0.001, "goals": [GOAL, ...]}
///   SKILL: {"skill": "clip_at", parameters ..., "at_most_s", "if_late": "fail" | "go_on", "until": CONDITION,
///           "meanwhile": [SKILL, ...]}
/// Every fault is appended, also what the scene lacks for a skill. Without a model of the reading all is checked but
/// what only a scene can tell, and the plan may only be thrown away.
Plan read_plan(const scene::JsonValue& demonstration, const RuleReading& reading);

}  // namespace trocar::training
