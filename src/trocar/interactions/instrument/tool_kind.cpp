#include <trocar/interactions/instrument/tool_kind.hpp>

namespace trocar::interactions {

std::string kinds_that(bool Abilities::*can) {
  std::string names;
  for (const KindOfTool& k : kToolKinds)
    if (k.can.*can) names += (names.empty() ? "" : " or ") + std::string(k.name);
  return names;
}

}  // namespace trocar::interactions
