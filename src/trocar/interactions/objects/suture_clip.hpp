// A clip applier closes on thread: what of it lies between the legs is clipped. The clip is part of that thread's State
// from then on (suture/thread/clips.hpp); its record in the clip buffer says how it was set.
#pragma once

#include <trocar/interactions/bodies/strand_body.hpp>
#include <trocar/interactions/objects/suture.hpp>

namespace trocar::interactions {

/// How far closing legs gather thread before them; what lies nearer to their middle than that is between them [m].
inline constexpr double kClipGathers = 0.0008;

/// Elements of a thread that lie between closed legs, as far as these are wide, become 1 in `gathered`.
void gather_thread(const SutureModel& m, const SutureState& s, const ToolModel& tool, const ToolShape& shape,
                   std::vector<std::uint8_t>& gathered) noexcept;

/// What came of a clip that closed: there is no thread between its legs; it sits on one; the thread bears no more
/// clips.
enum class ThreadClipping { no_thread, set, no_room };

/// Of all threads that with most stretches between the legs.
/// @param clip  has closed on nothing else; out: its place on the thread, and which
/// @param number  of the clip in the State's buffer
ThreadClipping clip_thread(const SutureModels& models, const ToolModel& tool, const ToolShape& shape,
                           std::int32_t number, Suture::States& states, Clip& clip) noexcept;

/// A clip of the buffer as it sits on its thread; null: on none, or it has detached.
const suture::ThreadClip* thread_clip(const Suture::States& states, const Clip& clip, std::int32_t number) noexcept;

}  // namespace trocar::interactions
