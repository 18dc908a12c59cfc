#include "report/chain/reference_values.h"

#include "engine/deck_run.h"
#include "support/csv_schema.h"

#include <algorithm>

namespace drumlin::post {

int ReferenceValue::decimals() const {
  const std::size_t point = low_text.find('.');
  return point == std::string::npos ? 0 : static_cast<int>(low_text.size() - point) - 1;
}

const std::vector<ReferenceValue> &reference_values() {
  using Value = ReferenceValue;
  static const std::vector<Value> values = [] {
    const CsvSchema<Value> schema(
        {csv_column("case", &Value::case_name), csv_column("transition", &Value::transition),
         csv_column("quantity", &Value::quantity), csv_column("unit", &Value::unit),
         csv_column("low", &Value::low_text), csv_column("low", &Value::low),
         csv_column("high", &Value::high_text), csv_column("high", &Value::high),
         csv_column("tolerance", &Value::tolerance), csv_column("source", &Value::source)});
    return schema.rows(read_table(input_file("chain/reference_values.csv")));
  }();
  return values;
}

const ReferenceValue *reference_value(const std::string &case_name, const std::string &transition,
                                      const std::string &quantity) {
  const std::vector<ReferenceValue> &all = reference_values();
  const auto found = std::find_if(all.begin(), all.end(), [&](const ReferenceValue &value) {
    return value.case_name == case_name && value.transition == transition && value.quantity == quantity;
  });
  return found == all.end() ? nullptr : &*found;
}

} // namespace drumlin::post
