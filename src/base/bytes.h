// Values to bytes and back, bit for bit: what a checkpoint keeps, and what the hash of a stage's inputs is taken of.
//
// A type of several parts lists them once, in a function fields() beside it that returns a tuple of references; a
// structured binding there makes the compiler ask for each new part. Numbers stand as they are in memory: the bytes are
// read by the build that wrote them and by no other. A reader never believes a length: what is not all there is
// nothing.
#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace servodx {

class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : left_(bytes) {}
  // False, and nothing is read from then on, where fewer are left.
  bool take(void* to, std::size_t count) {
    if (!ok_ || count > left_.size()) return ok_ = false;
    if (count > 0) std::memcpy(to, left_.data(), count);
    left_.remove_prefix(count);
    return true;
  }
  void refuse() { ok_ = false; }
  bool ok() const { return ok_; }
  std::size_t left() const { return left_.size(); }

 private:
  std::string_view left_;
  bool ok_ = true;
};

template <class T>
struct Bytes;  // write(std::string&, const T&), read(ByteReader&, T&)

template <class T>
void write_bytes(std::string& to, const T& value) {
  Bytes<T>::write(to, value);
}
template <class T>
void read_bytes(ByteReader& from, T& value) {
  Bytes<T>::read(from, value);
}

template <class T>
concept PlainNumber = std::is_arithmetic_v<T> || std::is_enum_v<T>;

template <PlainNumber T>
struct Bytes<T> {
  static void write(std::string& to, const T& value) { to.append(reinterpret_cast<const char*>(&value), sizeof value); }
  static void read(ByteReader& from, T& value) {
    if constexpr (std::is_same_v<T, bool>) {  // a byte that is neither is no bool
      unsigned char byte = 0;
      from.take(&byte, 1);
      if (byte > 1) from.refuse();
      value = byte == 1;
    } else {
      from.take(&value, sizeof value);
    }
  }
};

// Of a list: nothing is asked of memory for more than the bytes that are left could hold.
inline std::size_t read_count(ByteReader& from) {
  std::uint64_t count = 0;
  read_bytes(from, count);
  if (count > from.left()) from.refuse();
  return from.ok() ? static_cast<std::size_t>(count) : 0;
}

template <>
struct Bytes<std::string> {
  static void write(std::string& to, const std::string& value) {
    write_bytes(to, static_cast<std::uint64_t>(value.size()));
    to += value;
  }
  static void read(ByteReader& from, std::string& value) {
    value.resize(read_count(from));
    from.take(value.data(), value.size());
  }
};

template <class T>
struct Bytes<std::vector<T>> {
  static void write(std::string& to, const std::vector<T>& value) {
    write_bytes(to, static_cast<std::uint64_t>(value.size()));
    for (const T& item : value) write_bytes<T>(to, item);
  }
  static void read(ByteReader& from, std::vector<T>& value) {
    value.clear();
    for (std::size_t left = read_count(from); left > 0 && from.ok(); --left) {
      T item{};
      read_bytes(from, item);
      value.push_back(std::move(item));
    }
  }
};

template <class T, std::size_t N>
struct Bytes<std::array<T, N>> {
  static void write(std::string& to, const std::array<T, N>& value) {
    for (const T& item : value) write_bytes(to, item);
  }
  static void read(ByteReader& from, std::array<T, N>& value) {
    for (T& item : value) read_bytes(from, item);
  }
};

template <class T>
struct Bytes<std::optional<T>> {
  static void write(std::string& to, const std::optional<T>& value) {
    write_bytes(to, value.has_value());
    if (value) write_bytes(to, *value);
  }
  static void read(ByteReader& from, std::optional<T>& value) {
    bool there = false;
    read_bytes(from, there);
    value.reset();
    if (there) read_bytes(from, value.emplace());
  }
};

template <class K, class T>
struct Bytes<std::map<K, T>> {
  static void write(std::string& to, const std::map<K, T>& value) {
    write_bytes(to, static_cast<std::uint64_t>(value.size()));
    for (const auto& [key, item] : value) write_bytes(to, key), write_bytes(to, item);
  }
  static void read(ByteReader& from, std::map<K, T>& value) {
    value.clear();
    for (std::size_t left = read_count(from); left > 0 && from.ok(); --left) {
      K key{};
      read_bytes(from, key);
      read_bytes(from, value[key]);
    }
  }
};

template <class T>
concept HasFields = requires(T& value) {
  fields(value);
};

template <HasFields T>
struct Bytes<T> {
  static void write(std::string& to, const T& value) {
    std::apply([&](const auto&... part) { (write_bytes(to, part), ...); }, fields(const_cast<T&>(value)));
  }
  static void read(ByteReader& from, T& value) {
    std::apply([&](auto&... part) { (read_bytes(from, part), ...); }, fields(value));
  }
};

template <class T>
std::string to_bytes(const T& value) {
  std::string bytes;
  write_bytes(bytes, value);
  return bytes;
}

// Nothing where the bytes are not one whole value and no more.
template <class T>
std::optional<T> from_bytes(std::string_view bytes) {
  ByteReader reader(bytes);
  std::optional<T> value(std::in_place);
  read_bytes(reader, *value);
  if (!reader.ok() || reader.left() > 0) value.reset();
  return value;
}

}  // namespace servodx
