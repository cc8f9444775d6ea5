// What the vectors compute, so that tests can compare both widths with NumPy.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include "bindings/parts.hpp"
#include "simd.hpp"

namespace nb = nanobind;

namespace facegear {
namespace {

using Numbers = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Output = nb::ndarray<double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

template <int Width>
void multiply_add_all(const double* first, const double* second, const double* third, double* out,
                      size_t size) {
    using Vector = Lanes<Width>;
    for (size_t i = 0; i + Width <= size; i += Width) {
        multiply_add(Vector::load(first + i), Vector::load(second + i), Vector::load(third + i))
            .store(out + i);
    }
}

void bound_multiply_add(Numbers first, Numbers second, Numbers third, Output out, int width) {
    const size_t size = out.size();
    if (first.size() != size || second.size() != size || third.size() != size) {
        throw nb::value_error("the four arrays must have the same length");
    }
    if ((width != 4 && width != 8) || size % static_cast<size_t>(width) != 0) {
        throw nb::value_error("width must be 4 or 8, and the length a multiple of it");
    }
    nb::gil_scoped_release released;
    (width == 4 ? multiply_add_all<4> : multiply_add_all<8>)(first.data(), second.data(), third.data(),
                                                             out.data(), size);
}

} // namespace

void bind_arithmetic(nb::module_ module) {
    module.def("multiply_add", &bound_multiply_add, nb::arg("first"), nb::arg("second"), nb::arg("third"),
               nb::arg("out").noconvert(), nb::arg("width"));
}

} // namespace facegear
