// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "services/common/result.hpp"

namespace pursuit::sensor {

/// A filter as it is asked for, in a configuration or a request.
struct FilterSetting {
    struct Value {
        std::string name;
        double value = 0;

        friend bool operator==(const Value&, const Value&) = default;
    };

    std::string filter;  ///< Its name in the table of filters.
    std::string file;    ///< Of a mask or calibration, on the sensor's host; else empty.
    std::vector<Value> parameters;

    friend bool operator==(const FilterSetting&, const FilterSetting&) = default;
};

/// Reads "refractory period_us=1000", "undistort file=/etc/pursuit/lens.textproto": the name, then
/// name=number for each parameter; `file=` comes last and takes the rest of the text.
Result<FilterSetting> parse_filter(std::string_view text);

/// What parse_filter() reads.
std::string to_text(const FilterSetting& setting);

/// One number that a filter can be set to.
struct FilterParameter {
    std::string_view name;
    double min;
    double max;
    double standard;  ///< Its value where none is given.
    bool whole;       ///< Only whole numbers.
    std::string_view unit;
    std::string_view meaning;
};

/// The settings of one filter, complete and in range.
class FilterArguments {
 public:
    /// An error names an unknown, doubled or out-of-range parameter, and its bound.
    static Result<FilterArguments> of(const FilterSetting& setting,
                                      std::span<const FilterParameter> parameters);

    /// Of a parameter that the filter has.
    double operator[](std::string_view name) const;
    template <class Integer>
    Integer whole(std::string_view name) const {
        return static_cast<Integer>((*this)[name]);
    }

    const std::string& file() const { return file_; }

 private:
    FilterArguments(std::span<const FilterParameter> parameters, std::string file);

    std::span<const FilterParameter> parameters_;
    std::vector<double> values_;  // in their order
    std::string file_;
};

/// "1000", "0.5": as short as a person writes it.
std::string shown(double value);

}  // namespace pursuit::sensor
