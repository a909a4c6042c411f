#pragma once

#include <Eigen/Dense>
#include <cattaneo/input_error.hpp>
#include <cattaneo/load_pattern.hpp>
#include <nanobind/nanobind.h>
#include <string>
#include <vector>

// What Python passes. Every parameter of the module takes any object, so that what does not fit
// is refused here, in one sentence that names the argument and the entry, and not by a list of
// signatures. `what` is the name of the argument in these sentences. An object of a kind that
// is never right is a TypeError, a value or a shape that is not allowed an InputError.

namespace cattaneo::python
{

namespace nb = nanobind;
using Eigen::Index;

inline bool anything(PyObject *)
{
   return true;
}

// Any object; what it should be stands in the signature.
#define CATTANEO_ARGUMENT(Type, text)                                                          \
   class Type : public nb::object                                                              \
   {                                                                                           \
      NB_OBJECT(Type, nb::object, text, anything)                                              \
   }
CATTANEO_ARGUMENT(Numbers, "numpy.typing.ArrayLike");
CATTANEO_ARGUMENT(Number, "float");
CATTANEO_ARGUMENT(Whole, "int");
CATTANEO_ARGUMENT(Flag, "bool");
CATTANEO_ARGUMENT(Text, "str");
CATTANEO_ARGUMENT(File, "str | os.PathLike[str]");
CATTANEO_ARGUMENT(Loads, "collections.abc.Mapping[str, float]");
CATTANEO_ARGUMENT(Place, "float | collections.abc.Callable[[float, float], float]");

/// A named argument, which None may be passed for as anything else.
inline auto arg(const char *name)
{
   return nb::arg(name).none();
}

/// An object that should be one of ours.
template <class T>
struct Of
{
   nb::object object;
};

/// "None", "a str", "an array of shape (2, 3)": what sentences call an object.
std::string described(nb::handle object);
/// Throws a TypeError: "WHAT is DESCRIBED, must be NEEDED".
[[noreturn]] void refuse(nb::handle object, const std::string &what, const std::string &needed);
/// The name of a class without its module.
std::string class_name(nb::handle type);

template <class T>
T &given(nb::handle object, const std::string &what)
{
   if (nb::isinstance<T>(object) && nb::inst_ready(object)) { return *nb::inst_ptr<T>(object); }
   refuse(object, what, "of class " + class_name(nb::type<T>()));
}
template <class T>
T &given(const Of<T> &argument, const std::string &what)
{
   return given<T>(argument.object, what);
}

/// A whole number of Python's or NumPy's that no user gave.
Index integer(nb::handle object);

/// A list, tuple or other sequence of objects of one of our classes.
std::vector<nb::object> sequence(nb::handle object, const std::string &what);

double number(nb::handle object, const std::string &what);
long whole(nb::handle object, const std::string &what, long least, long most);
bool flag(nb::handle object, const std::string &what);
std::string text(nb::handle object, const std::string &what);
/// A name of a file, or a path.
std::string file(nb::handle object, const std::string &what = "file");
/// One of some words; its number in the list.
std::size_t choice(nb::handle object, const std::string &what,
                   const std::vector<std::string> &words);
template <class Enum>
Enum chosen(nb::handle object, const std::string &what, const std::vector<std::string> &words)
{
   return static_cast<Enum>(choice(object, what, words));
}

/// Finite numbers, as many as `size` unless that is negative.
Eigen::VectorXd vector(nb::handle object, const std::string &what, Index size = -1);
/// The same, or one number for all.
Eigen::VectorXd vector_or_number(nb::handle object, const std::string &what, Index size);
/// The same, which may be infinite: bounds.
Eigen::VectorXd bounds(nb::handle object, const std::string &what, Index size);
/// Finite numbers in rows and columns; a negative size is any.
Eigen::MatrixXd matrix(nb::handle object, const std::string &what, Index rows = -1,
                       Index columns = -1);
/// Whole numbers from `least` to `most`, or a mask of `most` + 1 truth values if `least` is 0.
std::vector<int> indices(nb::handle object, const std::string &what, long least, long most);
/// Whole numbers in rows and columns; negative sizes are any.
Eigen::MatrixXi whole_matrix(nb::handle object, const std::string &what, Index rows,
                             Index columns, long least, long most);
/// True if `object` is an array, or can be made one, of truth values.
bool is_mask(nb::handle object);

/// Numbers by names.
NamedLoads named_loads(nb::handle object, const std::string &what);

} // namespace cattaneo::python

namespace nanobind::detail
{

/// Takes any object; signatures show the class.
template <class T>
struct type_caster<cattaneo::python::Of<T>>
{
   static constexpr auto Name = const_name<T>();
   template <class>
   using Cast = cattaneo::python::Of<T>;
   template <class>
   static constexpr bool can_cast()
   {
      return true;
   }
   bool from_python(handle source, uint8_t, cleanup_list *) noexcept
   {
      value_.object = borrow(source);
      return true;
   }
   explicit operator cattaneo::python::Of<T>() { return std::move(value_); }

private:
   cattaneo::python::Of<T> value_;
};

} // namespace nanobind::detail
