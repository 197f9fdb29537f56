// Compliances of organs that were made before, in files named by the content that they follow from: stiffness, held
// nodes, nodes that are kept, loads, and the arithmetic's version. The same organ has the same file, so
// that a folder of them can be shared or copied. All that is in one is hashed; what is damaged or foreign counts as not
// there. The hash says nothing of who wrote it: the compiler checks it against the body (compliance_check.hpp). Two
// programs may write the same one at a time: files come into being whole.
//
// The folder is $TROCAR_CACHE, else $XDG_CACHE_HOME/trocar, else ~/.cache/trocar; at most 2 GB are kept there, what was
// used last.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <trocar/tissue/elastostatic/stiffness.hpp>

namespace trocar::scene {

/// What tissue::make_elastostatic() takes.
struct Compliance {
  std::vector<float> columns;  ///< (3 kept x 3 kept) [m/N]
  std::vector<float> fields;   ///< (loads x 3 kept) [m]
};

struct ContentKey {
  std::uint64_t a = 0, b = 0;
};
ContentKey content_key(const tissue::Stiffness& k, std::span<const int> kept, std::span<const double> loads);

struct CachedCompliance {
  bool found = false;
  Compliance compliance;
  std::filesystem::path file;  ///< where it is or would be; empty: there is no place for one
  std::string damage;          ///< what is wrong with the file that is there; empty: nothing, or there is none
};
CachedCompliance read_compliance(ContentKey key, int kept, int fields);

/// @return what kept it from being kept; empty: nothing did
std::string keep_compliance(ContentKey key, int kept, const Compliance& compliance);

/// Not made by this. Empty where the environment names none.
std::filesystem::path compliance_folder();

inline constexpr std::uintmax_t kMostCachedBytes = 2'000'000'000;
/// Takes away what was not used for longest, beyond `most` bytes.
void trim_compliances(const std::filesystem::path& folder, std::uintmax_t most);

}  // namespace trocar::scene
