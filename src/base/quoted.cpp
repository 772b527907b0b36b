#include "haptex/base/quoted.h"

namespace haptex::base {
namespace {

bool isControl(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < 0x20 || byte == 0x7f;
}

/// The byte is the second or a later one of a character in UTF-8.
bool continues(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

std::string escaped(char c) {
  if (c == '\n') return "\\n";
  if (c == '\t') return "\\t";
  constexpr char kDigits[] = "0123456789abcdef";
  const auto byte = static_cast<unsigned char>(c);
  return std::string("\\x") + kDigits[byte >> 4] + kDigits[byte & 0xf];
}

struct Begin {
  std::string text;
  bool whole;
};

Begin beginOf(const std::string& text) {
  std::string begin;
  for (std::size_t i = 0; i < text.size();) {
    std::string character = isControl(text[i]) ? escaped(text[i]) : std::string(1, text[i]);
    for (++i; i < text.size() && character.size() < kLongestQuote && continues(text[i]); ++i) {
      character += text[i];
    }
    if (begin.size() + character.size() > kLongestQuote) return {begin, false};
    begin += character;
  }
  return {begin, true};
}

std::string countOf(const std::string& text) {
  return "... (" + std::to_string(text.size()) + " characters)";
}

}  // namespace

std::string shortened(const std::string& text) {
  const Begin begin = beginOf(text);
  return begin.whole ? begin.text : begin.text + countOf(text);
}

std::string quoted(const std::string& text) {
  const Begin begin = beginOf(text);
  return "'" + begin.text + "'" + (begin.whole ? "" : countOf(text));
}

}  // namespace haptex::base
