// How messages repeat texts that came from outside: from files, parameters, messages and requests.
#pragma once

#include <cstddef>
#include <string>

namespace haptex::base {

/// What messages repeat of a text at most, in bytes.
constexpr std::size_t kLongestQuote = 200;

/// The text, made fit for a line of a message: control characters are written as \n, \t or \x1b,
/// and of one that is then longer than kLongestQuote bytes the begin stands, followed by "...
/// (N characters)" with the bytes of the whole. UTF-8 is not cut within a character.
std::string shortened(const std::string& text);

/// The same between single quotes: 'text', or 'begin'... (N characters).
std::string quoted(const std::string& text);

}  // namespace haptex::base
