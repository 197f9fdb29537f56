// Threads that must wake up on time.
#pragma once

namespace trocar::devices {

/// Asks for a real-time priority of the calling thread, and for exact sleeps. @return was the priority given?
bool raise_priority() noexcept;

}  // namespace trocar::devices
