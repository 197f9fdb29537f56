// Text that came from outside, as a terminal may be given it.
#pragma once

#include <string>
#include <string_view>

namespace trocar::core {

/// The text with its control characters (C0, DEL, C1) and those that turn the direction of writing spelled out:
/// ESC becomes the escape u001b. A terminal obeys none of what is left.
std::string printable(std::string_view text);

}  // namespace trocar::core
