#include <utility>

#include <trocar/core/error.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>

namespace trocar::core {
namespace {

std::string joined(const std::vector<Fault>& faults) {
  std::string text;
  for (const Fault& fault : faults) {
    if (!text.empty()) text += '\n';
    text += to_string(fault);
  }
  return text;
}

}  // namespace

std::string to_string(const Fault& fault) {
  std::string text = fault.at.file;
  if (fault.at.line > 0) {
    text += ':' + std::to_string(fault.at.line);
    if (fault.at.column > 0) text += ':' + std::to_string(fault.at.column);
  }
  if (!text.empty()) text += ": ";
  const char* translated = tr(fault.message.c_str());  // a message without a translation may hold a zero
  return printable(text + (translated == fault.message.c_str() ? fault.message : translated));
}

BadInput::BadInput(std::vector<Fault> faults) : std::runtime_error(joined(faults)), m_faults(std::move(faults)) {}

}  // namespace trocar::core
