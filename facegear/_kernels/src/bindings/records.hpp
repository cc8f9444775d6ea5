// Arrays and records of Python as kernels take them: types and shapes are checked here, once.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <string>

#include "tables.hpp"

namespace facegear::bindings {

namespace nb = nanobind;

// Values that are only read, one row after the other: converted where their type or layout is another.
template <class Value, int Dimensions>
using Given = nb::ndarray<const Value, nb::ndim<Dimensions>, nb::c_contig, nb::device::cpu>;

// Values that a kernel writes: bound with noconvert(), so that a copy is never written to instead.
template <class Value, int Dimensions>
using Written = nb::ndarray<Value, nb::ndim<Dimensions>, nb::c_contig, nb::device::cpu>;

template <class Array>
inline Index extent(const Array& array, std::size_t axis) {
    return static_cast<Index>(array.shape(axis));
}

template <class Array>
inline auto table_of(const Array& array) {
    return Table<typename Array::Scalar>{array.data(), extent(array, 0), extent(array, 1)};
}

template <class Array>
inline auto list_of(const Array& array) {
    return List<typename Array::Scalar>{array.data(), extent(array, 0)};
}

// Raises ValueError with a message unless what is asked for holds.
inline void require(bool holds, const char* message) {
    if (!holds) throw nb::value_error(message);
}

// Raises ValueError unless all values are from `low` to `high`, both included.
inline void require_within(List<const Index> values, Index low, Index high, const char* message) {
    for (const Index value : values) require(low <= value && value <= high, message);
}

// Fields of a NamedTuple, or of any object that has them.
class Record {
  public:
    explicit Record(nb::handle object) : object(nb::borrow(object)) {}

    double number(const char* field) const { return get<double>(field, "a number"); }

    Record record(const char* field) const { return Record(object.attr(field)); }

    template <class Value, int Dimensions>
    Given<Value, Dimensions> array(const char* field) const {
        return get<Given<Value, Dimensions>>(field, "an array of another type or number of dimensions");
    }

    template <class Value, int Dimensions>
    Written<Value, Dimensions> output(const char* field) const {
        return get<Written<Value, Dimensions>>(field, "an array that can be written in place", false);
    }

  private:
    nb::object object;

    template <class Type>
    Type get(const char* field, const char* wanted, bool convert = true) const {
        Type value;
        const nb::object given = object.attr(field);
        if (!nb::try_cast<Type>(given, value, convert)) {
            throw nb::type_error((std::string("the field ") + field + " must be " + wanted).c_str());
        }
        return value;
    }
};

} // namespace facegear::bindings
