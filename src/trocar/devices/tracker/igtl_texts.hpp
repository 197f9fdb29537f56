// What messages of version 2 and 3 carry beside their content: an extended header before it, and after it a table of
// named texts (the protocol's metadata). Two of the texts matter here: whether a tool is seen, and a name that is
// longer than the protocol's field.
#pragma once

#include <utility>
#include <vector>

#include <trocar/devices/tracker/igtl_bytes.hpp>

namespace trocar::devices {

inline constexpr std::size_t kIgtlName = 20;      ///< letters of a name in the protocol; longer ones are cut
inline constexpr std::size_t kLongestName = 256;  ///< of a whole name that is taken from a text

/// Keys and their values, as they were sent.
using IgtlTexts = std::vector<std::pair<std::string, std::string>>;

struct IgtlBody {
  IgtlBytes content;
  IgtlTexts texts;
};

/// A body without what is around its content. A body of version 2 or 3 without a sound extended header is all content,
/// as servers exist that announce a version and send an older one; its size then says whether it can be that.
IgtlBody split_body(int version, IgtlBytes body);

/// Is this the name of the same tool? Either may be cut to the protocol's 20 letters.
bool same_tool_name(const std::string& one, const std::string& other) noexcept;

/// The whole name of a device, else `cut`: the text "IGTL_DEVICE_NAME", or a longer text that begins with a name of 20
/// letters.
std::string whole_name(const IgtlTexts& texts, const std::string& cut);
/// The same of an element of TDATA or QTDATA, whose texts are named after it: "LeftToReferenceStatus".
std::string whole_element_name(const IgtlTexts& texts, const std::string& cut);

/// Why a tool is not seen: the server's word, such as MISSING or OUT_OF_VIEW. Empty: it is seen, or nothing is said.
/// PLUS sends "TransformStatus" with TRANSFORM and POSITION, and NAME + "Status" with TDATA.
/// @param element  of TDATA or QTDATA; empty: the message is about one tool
std::string why_unseen(const IgtlTexts& texts, const std::string& element);
/// Do the texts say that the tool is seen?
bool is_called_seen(const IgtlTexts& texts, const std::string& element);

}  // namespace trocar::devices
