// Arrays between Python and the kernels: shapes, types and contiguity are checked here, once.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

namespace facegear {

template <int Dimensions>
using Doubles =
    nanobind::ndarray<const double, nanobind::ndim<Dimensions>, nanobind::c_contig, nanobind::device::cpu>;
using Integers =
    nanobind::ndarray<const std::int64_t, nanobind::ndim<1>, nanobind::c_contig, nanobind::device::cpu>;

// Raise ValueError unless something holds.
inline void require(bool holds, const std::string& message) {
    if (!holds) throw nanobind::value_error(message.c_str());
}

// The numbers of an array, which must have a shape.
template <class Value, class Array>
std::vector<Value> numbers_of(const Array& array, std::initializer_list<std::int64_t> shape,
                              const char* name) {
    bool fits = array.ndim() == shape.size();
    std::size_t axis = 0;
    for (const std::int64_t length : shape)
        fits = fits && static_cast<std::int64_t>(array.shape(axis++)) == length;
    require(fits, std::string(name) + " has the wrong shape");
    return std::vector<Value>(array.data(), array.data() + array.size());
}

// A view of numbers that an object of Python's owns.
template <class Value>
nanobind::ndarray<nanobind::numpy, Value> view_of(std::vector<Value>& values,
                                                  std::initializer_list<std::size_t> shape,
                                                  nanobind::handle owner) {
    return {values.data(), shape, owner};
}

} // namespace facegear
