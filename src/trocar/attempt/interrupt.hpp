// Ctrl-C and kill end an attempt properly: the recording gets its end mark and the result is printed.
#pragma once

namespace trocar::attempt {

/// From now on SIGINT and SIGTERM only set a flag; a second one ends the program at once.
void catch_interrupts();
bool interrupted();

}  // namespace trocar::attempt
