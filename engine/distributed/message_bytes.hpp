#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace steerstat {

/// Puts values together to a message. All ranks are the same program on machines that store numbers alike.
class MessageWriter {
 public:
  template <class Value>
  MessageWriter& put(const Value& value) {
    return put_all(std::span<const Value>(&value, 1));
  }

  MessageWriter& put(const std::string& text) { return put(std::uint64_t{text.size()}).put_all(std::span(text)); }

  template <class Value, std::size_t extent>
  MessageWriter& put_all(std::span<Value, extent> values) {
    static_assert(std::is_trivially_copyable_v<Value>);
    const auto bytes = std::as_bytes(values);
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return *this;
  }

  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

/// Takes it apart again, in the same order.
class MessageReader {
 public:
  explicit MessageReader(std::span<const std::byte> bytes) : left_(bytes) {}

  template <class Value>
  Value get() {
    static_assert(std::is_trivially_copyable_v<Value>);
    Value value{};
    std::memcpy(&value, take(sizeof(Value)).data(), sizeof(Value));
    return value;
  }

  std::string get_text() {
    const auto bytes = take(get<std::uint64_t>());
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  /// All that is left.
  template <class Value>
  std::vector<Value> get_rest() {
    static_assert(std::is_trivially_copyable_v<Value>);
    std::vector<Value> values(left_.size() / sizeof(Value));
    const auto bytes = take(values.size() * sizeof(Value));
    if (!values.empty()) std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
    return values;
  }

 private:
  std::span<const std::byte> take(std::uint64_t size) {
    if (size > left_.size()) throw std::logic_error("a message between ranks ended early");
    const auto taken = left_.first(size);
    left_ = left_.subspan(size);
    return taken;
  }

  std::span<const std::byte> left_;
};

}  // namespace steerstat
