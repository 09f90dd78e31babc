// A kernel's run in parts. Included only by the translation units that instantiate it.
#pragma once
#include <cstddef>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "simulate/kernels.h"
#include "simulate/pack_run.h"
#include "simulate/run_in_parts.h"
#include "simulate/scenario.h"

namespace servodx {

template <class T, class Effects>
class RunInPartsOf final : public RunInParts {
 public:
  RunInPartsOf(const Scenario& in, const ParameterVector& candidate, Trajectory& result, const SimulateOptions& options)
      : candidate_(&candidate), result_(&result), run_(in, &candidate_, &result_, 1, options) {}

  bool go_on() override {
    run_.go_on();
    while (run_.under_way()) run_.next(Unwatched{});
    return result_->ok;
  }
  void shift_rod(double by) override { run_.shift_rod(T(by)); }
  std::string memory() override {
    std::string bytes;
    each([&](auto& x) { bytes.append(reinterpret_cast<const char*>(&x), sizeof(x)); });
    return bytes;
  }
  bool recall(std::string_view bytes) override {
    std::size_t size = 0, at = 0;
    each([&](auto& x) { size += sizeof(x); });
    if (bytes.size() != size) return false;
    each([&](auto& x) {
      std::memcpy(static_cast<void*>(&x), bytes.data() + at, sizeof(x));
      at += sizeof(x);
    });
    return true;
  }

 private:
  template <class F>
  void each(F&& f) {
    std::apply([&](auto&... x) { (each_of(x, f), ...); }, run_.memory());
  }
  // A tuple of effects' memories one by one: it is not copied as bytes.
  template <class... M, class F>
  static void each_of(std::tuple<M...>& memories, F& f) {
    std::apply([&](auto&... x) { (each_of(x, f), ...); }, memories);
  }
  template <class X, class F>
  static void each_of(X& x, F& f) {
    static_assert(std::is_trivially_copyable_v<X>, "a memory is plain numbers: it is saved and taken up again");
    if constexpr (!std::is_empty_v<X>) f(x);
  }

  const ParameterVector* candidate_;
  Trajectory* result_;
  Run<T, Effects> run_;
};

template <class T, class Effects>
std::unique_ptr<RunInParts> make_in_parts(const Scenario& in, const ParameterVector& candidate, Trajectory& result,
                                          const SimulateOptions& options) {
  return std::make_unique<RunInPartsOf<T, Effects>>(in, candidate, result, options);
}

template <class T, class Effects>
Kernel kernel_of() {
  return {&run_pack<T, Effects>, &make_in_parts<T, Effects>};
}

}  // namespace servodx
