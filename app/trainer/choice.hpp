// What people choose in the trainer's menus.
#pragma once

namespace trocar::app {

enum class Choice { none, resume, restart, finish, settings, display, views, help, report, watch, start_screen, quit };

}  // namespace trocar::app
