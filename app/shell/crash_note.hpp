// What a person can report when the program dies of a fault of its own: where it was, on standard error.
#pragma once

namespace trocar::app {

/// From now on a signal that says that the program itself is broken (bad memory, a failed check) writes the calls that
/// led to it before the program dies of it as it would have. Recordings need no saving: they are on disk as they grow.
void leave_a_note_when_crashing();

}  // namespace trocar::app
