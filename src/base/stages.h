// A call's stages, and the checkpoint that keeps them: the one seam between what computes and what is kept.
//
//   const Ends ends = stages.made("search", [&] { return search(from); }, from, iterations);
//
// The stage is a function of the inputs that follow it and of those that the call's stages were named with; it is taken
// from the checkpoint where that holds it. It is kept once it is finished and the call has not been stopped: what a
// stop has cut short never is. Without a checkpoint nothing is hashed or copied.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "base/bytes.h"
#include "base/checkpoint.h"
#include "base/sha256.h"
#include "servodx/watch.h"

namespace servodx {

class Stages {
 public:
  Stages() = default;  // keeps nothing
  template <class... Input>
  Stages(const Watch& watch, std::string_view call, const Input&... inputs) : watch_(watch) {
    watch_.progress = nullptr;
    if (keeps()) of_ = key(call, watch_.checkpoint->build(), inputs...);
  }

  bool keeps() const { return watch_.checkpoint != nullptr; }

  // Of a part of what these are about.
  template <class... Input>
  Stages part(std::string_view name, const Input&... inputs) const {
    Stages out = *this;
    if (keeps()) out.of_ = key(name, inputs...);
    return out;
  }

  template <class Make, class... Input>
  std::invoke_result_t<Make> made(std::string_view name, const Make& make, const Input&... inputs) const {
    using Made = std::invoke_result_t<Make>;
    if (!keeps() || watch_.stopped()) return make();
    const std::string under = key(name, inputs...);
    if (std::optional<Made> kept = find<Made>(under)) return std::move(*kept);
    Made out = make();
    keep(under, out);
    return out;
  }

  // The two halves of it, for what is kept on the way.
  template <class... Input>
  std::string key(std::string_view name, const Input&... inputs) const {
    std::string bytes = of_;
    write_bytes(bytes, std::string(name));
    (write_bytes(bytes, inputs), ...);
    return sha256(bytes);
  }
  template <class Made>
  std::optional<Made> find(const std::string& under) const {
    const std::optional<std::string> bytes = watch_.checkpoint->find(under);
    return bytes ? from_bytes<Made>(*bytes) : std::nullopt;
  }
  template <class Made>
  void keep(const std::string& under, const Made& made) const {
    if (!watch_.stopped()) watch_.checkpoint->keep(under, to_bytes(made));
  }

 private:
  Watch watch_;
  std::string of_;
};

}  // namespace servodx
