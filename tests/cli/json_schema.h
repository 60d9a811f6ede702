// As much of JSON Schema as docs/reference/summary.schema.json uses.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace accrete::cli {

class JsonSchema {
 public:
  explicit JsonSchema(nlohmann::json schema) : root_(std::move(schema)) {}

  // One line for everything that is wrong with `value`.
  [[nodiscard]] std::vector<std::string> problems(const nlohmann::json& value) const {
    std::vector<std::string> out;
    check(value, root_, "", out);
    return out;
  }

 private:
  using json = nlohmann::json;

  static bool is(const json& value, const std::string& type) {
    if (type == "integer") return value.is_number_integer();
    if (type == "number") return value.is_number();
    return type == value.type_name();
  }

  void check(const json& value, const json& schema, const std::string& at, std::vector<std::string>& out) const {
    if (schema.contains("$ref"))
      return check(value, root_.at(json::json_pointer(schema["$ref"].get<std::string>().substr(1))), at, out);
    if (schema.contains("const") && value != schema["const"]) out.push_back(at + ": not the constant");
    if (schema.contains("enum") &&
        std::find(schema["enum"].begin(), schema["enum"].end(), value) == schema["enum"].end())
      out.push_back(at + ": not in the enumeration: " + value.dump());
    if (schema.contains("type")) {
      const json types = schema["type"].is_array() ? schema["type"] : json::array({schema["type"]});
      bool any = false;
      for (const json& type : types) any = any || is(value, type);
      if (!any) out.push_back(at + ": is no " + schema["type"].dump() + ": " + value.dump());
    }
    if (schema.contains("minimum") && value.is_number() && value < schema["minimum"]) out.push_back(at + ": too small");
    if (schema.contains("items"))
      for (std::size_t i = 0; i < value.size(); ++i)
        check(value.at(i), schema["items"], at + "/" + std::to_string(i), out);
    if (value.is_object()) check_members(value, schema, at, out);
  }

  void check_members(const json& value, const json& schema, const std::string& at,
                     std::vector<std::string>& out) const {
    const json properties = schema.value("properties", json::object());
    for (const json& key : schema.value("required", json::array()))
      if (!value.contains(key.get<std::string>())) out.push_back(at + ": lacks " + key.get<std::string>());
    for (const auto& [key, member] : value.items()) {
      if (properties.contains(key)) {
        check(member, properties[key], at + "/" + key, out);
      } else if (schema.contains("additionalProperties")) {
        if (schema["additionalProperties"] == false)
          out.push_back(at + ": has the undocumented key " + key);
        else
          check(member, schema["additionalProperties"], at + "/" + key, out);
      }
    }
  }

  json root_;
};

}  // namespace accrete::cli
