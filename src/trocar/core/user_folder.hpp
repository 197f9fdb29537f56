// Where the program keeps what belongs to this person: settings, sessions, recordings, reports, own scenes.
#pragma once

#include <filesystem>
#include <string>

namespace trocar::core {

/// An environment variable's value, empty where it is not set.
std::string environment(const char* name);

/// $TROCAR_DATA, else $XDG_DATA_HOME/trocar, else ~/.local/share/trocar. Not made by this.
std::filesystem::path user_folder();

}  // namespace trocar::core
