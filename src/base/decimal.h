// A decimal number at the start of some text, correctly rounded, for the numbers that logs are made of.
//
// Up to 19 digits make an integer below 2^64; where it is at most 2^53 and the power of ten at most 10^22, both are
// exact doubles and one multiplication or division rounds once (Clinger, PLDI 1990). Eight digits are taken at a time
// (Lemire, Software: Practice and Experience 51, 2021). All else, signs '+', nan and overflow included, is left to
// std::from_chars, which costs two to three times as much.
#pragma once
#include <bit>
#include <cstdint>
#include <cstring>

namespace servodx {

namespace decimal {

inline constexpr double powers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
inline constexpr int largest_power = 22;
inline constexpr int most_digits = 19;

inline bool is_digit(char c) { return static_cast<unsigned char>(c - '0') < 10; }

// Appends the digits at p to `value`; the caller watches their number.
inline const char* take_digits(const char* p, const char* end, std::uint64_t& value) {
  for (; p != end && is_digit(*p); ++p) value = value * 10 + static_cast<std::uint64_t>(*p - '0');
  return p;
}

// The same, eight at a time while they last.
inline const char* take_many_digits(const char* p, const char* end, std::uint64_t& value) {
  if constexpr (std::endian::native == std::endian::little) {
    while (end - p >= 8) {
      std::uint64_t eight;
      std::memcpy(&eight, p, 8);
      const std::uint64_t carry = eight + 0x4646464646464646u, borrow = eight - 0x3030303030303030u;
      if ((carry | borrow) & 0x8080808080808080u) break;  // one of them is no digit
      eight = borrow * 10 + (borrow >> 8);                // pairs
      eight = ((eight & 0x000000FF000000FFu) * 0x000F424000000064u +
               ((eight >> 16) & 0x000000FF000000FFu) * 0x0000271000000001u) >>
              32;
      value = value * 100000000u + static_cast<std::uint32_t>(eight);
      p += 8;
    }
  }
  return take_digits(p, end, value);
}

}  // namespace decimal

// The end of the number at p, which is in `value`; null where it takes more than the above, and `value` is open then.
// `point` is accepted beside '.'.
inline const char* parse_decimal(const char* p, const char* end, char point, double& value) {
  using namespace decimal;
  const bool negative = p != end && *p == '-';
  p += negative;
  std::uint64_t digits = 0;
  const char* const whole = p;
  p = take_digits(p, end, digits);
  long count = p - whole;
  long exponent = 0;
  if (p != end && (*p == '.' || *p == point)) {
    const char* const part = ++p;
    p = take_many_digits(p, end, digits);
    exponent = part - p;
    count -= exponent;
  }
  if (count == 0 || count > most_digits) return nullptr;
  if (p != end && (*p == 'e' || *p == 'E')) {
    ++p;
    const bool minus = p != end && *p == '-';
    if (p != end && (*p == '-' || *p == '+')) ++p;
    long written = 0;
    const char* const first = p;
    for (; p != end && is_digit(*p) && p - first < 4; ++p) written = written * 10 + (*p - '0');
    if (p == first || (p != end && is_digit(*p))) return nullptr;
    exponent += minus ? -written : written;
  }
  if (digits > (std::uint64_t{1} << 53) || exponent < -largest_power || exponent > largest_power) return nullptr;
  const double exact = static_cast<double>(digits);
  const double size = exponent < 0 ? exact / powers[-exponent] : exact * powers[exponent];
  value = negative ? -size : size;
  return p;
}

}  // namespace servodx
