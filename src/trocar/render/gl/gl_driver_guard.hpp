// A fault of Mesa's software rasteriser that ends programs, and how this one lives with it.
//
// llvmpipe's fences are read without their lock: the drawing thread sees the last rasteriser thread count itself in,
// takes the fence for done and frees it, while that thread has yet to broadcast and to unlock. Its last store then hits
// a freed block of the heap, and a later allocation dies anywhere (seen with Mesa 22.3.6 on busy machines, in minutes;
// the read is the same in later releases). With 0.2 ms of delay before that broadcast every start dies.
//
// The fence's mutex is destroyed before its memory is freed. So pthread_mutex_destroy is defined here too, in front of
// the C library's, and first waits until the holder of the mutex has left. Nobody may destroy a locked mutex, so for
// all others nothing changes.
#pragma once

namespace trocar::render {

/// Links the guard in; nothing else.
void link_driver_guard() noexcept;

}  // namespace trocar::render
