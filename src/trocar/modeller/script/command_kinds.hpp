// The commands of scripts, a function a file. Private to the folder.
#pragma once

#include <trocar/modeller/script/session.hpp>

namespace trocar::modeller {

std::vector<Command> session_commands();  ///< documents, builds, test drives, pictures
std::vector<Command> scan_commands();     ///< scans, segments, organs of them

}  // namespace trocar::modeller
