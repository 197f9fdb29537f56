// What gzip or zlib packed, bounded by what the reader knows that it wants. Used by the readers only.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace trocar::geometry {

enum class Wrapping : unsigned char { gzip, zlib, none };

/// Bytes `from` up to `from + count` of what was packed; what comes before is unpacked and dropped. Fewer are fine:
/// what a beginning looks like is asked for here. Memory grows with what is found.
/// @throws core::BadInput  named `file`
std::vector<char> inflated(std::string_view packed, Wrapping wrapping, std::size_t from, std::size_t count,
                           const std::string& file);

/// Some of the bytes that a header announces.
struct PackedPart {
  std::size_t from = 0, count = 0;  ///< what is wanted
  std::size_t behind = 0;           ///< announced behind it

  std::size_t all() const { return from + count + behind; }
};

/// The part of what was packed. All of it is unpacked, as damage shows in the check sum at its end only. Files of
/// several members, as parallel packers write them, are one. No more memory is asked for than the packed bytes can
/// fill.
/// @param progress  called with the share that is done; may throw
/// @param more      out: are there bytes behind those that were announced?
/// @throws core::BadInput  named `file`: for damage, for fewer bytes, and for very many more
std::vector<char> inflated_part(std::string_view packed, Wrapping wrapping, PackedPart wanted, const std::string& file,
                                const std::function<void(double)>& progress, bool& more);

std::string gzipped(std::string_view bytes);

}  // namespace trocar::geometry
