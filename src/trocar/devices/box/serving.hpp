// The software box at its pseudo-terminal, paced by the clock: a terminal would pass a hundred blocks in the time that
// a line needs for the first byte.
#pragma once

#include <functional>

#include <trocar/devices/box/pseudo_terminal.hpp>
#include <trocar/devices/box/software_box.hpp>

namespace trocar::devices {

enum class PortReader : unsigned char { none, asks, stopped };

/// Until `stop` says so, which is asked some fifty times a second.
/// @param changed  is called when the reader opens or closes the port, and when its requests stop or continue
void serve(SoftwareBox& box, PseudoTerminal& terminal, const std::function<bool()>& stop,
           const std::function<void(PortReader)>& changed = {});

}  // namespace trocar::devices
