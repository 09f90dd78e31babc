// A JSON value inside a struct whose header only declares it: what passes such a struct on need not know the library.
//
// Never null, copied with what it holds. Begins as an empty object.
#pragma once
#include <memory>
#include <nlohmann/json_fwd.hpp>

namespace servodx::report {

class HeldJson {
 public:
  using Value = nlohmann::ordered_json;

  HeldJson();
  HeldJson(const HeldJson& other);
  HeldJson& operator=(const HeldJson& other);
  ~HeldJson();

  Value& operator*() { return *json_; }
  const Value& operator*() const { return *json_; }
  Value* operator->() { return json_.get(); }
  const Value* operator->() const { return json_.get(); }

 private:
  std::unique_ptr<Value> json_;
};

}  // namespace servodx::report
