// A connection to a service over TCP.
#pragma once

#include <string>

namespace trocar::devices {

/// @returns a connected socket that is closed in children, or -1 and in `why` what the system says. Waits two seconds
/// for an answer at most, and as long whenever it sends.
int connect_tcp(const std::string& address, int port, std::string& why);

}  // namespace trocar::devices
