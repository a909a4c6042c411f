#pragma once

#include "arguments.hpp"
#include <nanobind/ndarray.h>

// Arrays that are given to Python.

namespace cattaneo::python
{

CATTANEO_ARGUMENT(Reals, "numpy.typing.NDArray[numpy.float64]", anything);
CATTANEO_ARGUMENT(Integers, "numpy.typing.NDArray[numpy.intc]", anything);
CATTANEO_ARGUMENT(States, "numpy.typing.NDArray[numpy.int8]", anything);

/// A view of the entries of a matrix or vector that `owner` keeps alive and in its place.
/// @tparam Entry const double: Python may not write
template <class Entry, class Dense>
Reals view(Dense &&M, nb::handle owner)
{
   constexpr bool one = std::decay_t<Dense>::ColsAtCompileTime == 1;
   const std::size_t shape[] = {static_cast<std::size_t>(M.rows()),
                                static_cast<std::size_t>(M.cols())};
   const std::int64_t strides[] = {1, M.outerStride()};
   const nb::ndarray<nb::numpy, Entry> array(M.data(), one ? 1 : 2, shape, owner, strides);
   return nb::borrow<Reals>(nb::cast(array));
}
template <class Dense>
Reals view(const Dense &M, nb::handle owner)
{
   return view<const double>(M, owner);
}

/// An array of its own.
template <class Array = Reals, class Dense>
Array array(Dense values)
{
   using Scalar = typename Dense::Scalar;
   constexpr bool one = Dense::ColsAtCompileTime == 1;
   auto *kept = new Dense(std::move(values));
   const nb::capsule owner(kept, [](void *p) noexcept { delete static_cast<Dense *>(p); });
   const std::size_t shape[] = {static_cast<std::size_t>(kept->rows()),
                                static_cast<std::size_t>(kept->cols())};
   const std::int64_t strides[] = {kept->IsRowMajor ? kept->outerStride() : 1,
                                   kept->IsRowMajor ? 1 : kept->outerStride()};
   const nb::ndarray<nb::numpy, Scalar> all(kept->data(), one ? 1 : 2, shape, owner, strides);
   return nb::borrow<Array>(nb::cast(all));
}

inline Integers array_of_indices(const std::vector<int> &values)
{
   return array<Integers>(
      Eigen::VectorXi(Eigen::Map<const Eigen::VectorXi>(values.data(), values.size())));
}
inline Integers array_of_indices(const std::vector<Index> &values)
{
   return array_of_indices(std::vector<int>(values.begin(), values.end()));
}

/// The value that Python gets: a matrix or vector is copied to an array of its own.
template <class Value>
auto given_out(const Value &value)
{
   if constexpr (std::is_base_of_v<Eigen::EigenBase<Value>, Value>) { return array(value); }
   else { return value; }
}
/// A getter of a member of a member, which is copied:
/// `.def_prop_ro("seconds", copied(&March::report, &MarchReport::seconds))`.
template <class Class, class Part, class From, class Member>
auto copied(Part Class::*part, Member From::*member)
{
   return [part, member](const Class &self) { return given_out(self.*part.*member); };
}

/// A getter of a member as a view, read-only: `.def_prop_ro("p", viewed(&ContactState::p))`.
template <class Class, class Member>
auto viewed(Member Class::*member)
{
   return [member](const Class &self) { return view(self.*member, nb::find(self)); };
}

} // namespace cattaneo::python
