// What skills that tie ask of thread, stitch and hands.
#pragma once

#include <string>

#include <trocar/training/observe/stitches.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training::tying {

/// Where the thread leaves what a hand holds of the suture.
Vec3d held_thread(const Surgeon& op, int hand);
/// Of what the hand holds at it [N].
double pull_of(const Surgeon& op, int hand);
/// Against a way that it is drawn, of that and of whatever its instrument touches: a thread's end that lies round the
/// jaws that hold it pulls at their outside [N].
double felt_by(const Surgeon& op, int hand, Vec3d against);
/// Against gravity.
Vec3d upwards(const Surgeon& op);
/// The middle of the stitch, as high as the highest place where thread lies in tissue; jaws stay above it.
bool find_stitch(const Surgeon& op, Vec3d& middle);
/// Where the hand holds the thread, or the needle that it hangs on [m].
double held_at(const Surgeon& op, int hand);
/// Thread between what the hand holds of it and the stitch, where knots lie [m].
double free_thread(const Surgeon& op, int hand);
/// Something is tied, as far as who has watched it knows: what has been drawn tight is hard to read.
bool ties(Surgeon& op);
/// Every tick while thread is tied: what it is tied in is seen now and then.
void watch(Surgeon& op);
/// The largest tension in that much thread from the hand that holds it towards the stitch; in throws that have been
/// drawn tight there is some that is no business of the hand's [N].
double tension_from(const Surgeon& op, int hand, double much);
/// No lower than a little above where the thread leaves tissue, and no part of a needle that the hand holds lower.
Vec3d above_tissue(const Surgeon& op, int hand, Vec3d at);
/// The place where the thread is held to there.
bool lead(Surgeon& op, int hand, Vec3d to, double speed);
/// Empty: the scene has thread, and the hand can hold it.
std::string lacks_thread(const sim::Model& model, const SkillArgs& args);

}  // namespace trocar::training::tying
