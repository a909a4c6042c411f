#pragma once

#include <Eigen/Dense>
#include <cattaneo/input_error.hpp>
#include <nanobind/nanobind.h>
#include <string>
#include <vector>

// Arrays and files that Python passes; nanobind converts all other arguments. `what` is the
// name of the argument in sentences. An object of a wrong kind is a TypeError; a value or a
// shape that is not allowed is an InputError.

namespace cattaneo::python
{

namespace nb = nanobind;
using Eigen::Index;
using nb::arg;

inline bool anything(PyObject *)
{
   return true;
}
inline bool is_dict(PyObject *object)
{
   return PyDict_Check(object) != 0;
}

// The type of an object in signatures, and its check by nanobind.
#define CATTANEO_ARGUMENT(Type, text, check)                                                   \
   class Type : public nb::object                                                              \
   {                                                                                           \
      NB_OBJECT(Type, nb::object, text, check)                                                 \
   }
CATTANEO_ARGUMENT(Numbers, "numpy.typing.ArrayLike", anything);
CATTANEO_ARGUMENT(NamedNumbers, "collections.abc.Mapping[str, numpy.typing.ArrayLike]",
                  is_dict);
CATTANEO_ARGUMENT(File, "str | os.PathLike[str]", anything);

/// Throws a TypeError: "WHAT is a list of 2 entries, must be NEEDED".
[[noreturn]] void refuse(nb::handle object, const std::string &what, const std::string &needed);

/// A whole number of Python or NumPy that no user gave.
Index integer(nb::handle object);

/// InputError unless it is a finite number.
double finite(double value, const char *what);
/// InputError unless it is from `least` to `most`.
int within(int value, const char *what, int least, int most);
/// A finite number from an object, which may be any number of Python or NumPy.
double number(nb::handle object, const std::string &what);
/// A file, given by name or as a path.
std::string file(nb::handle object, const std::string &what = "file");

/// Finite numbers, as many as `size` unless that is negative.
Eigen::VectorXd vector(nb::handle object, const std::string &what, Index size = -1);
/// The same, or one number for all.
Eigen::VectorXd vector_or_number(nb::handle object, const std::string &what, Index size);
/// The same, which may be infinite: bounds.
Eigen::VectorXd bounds(nb::handle object, const std::string &what, Index size);
/// Finite numbers in rows and columns; a negative size allows any.
Eigen::MatrixXd matrix(nb::handle object, const std::string &what, Index rows = -1,
                       Index columns = -1);
/// Whole numbers from `least` to `most`, or a mask of `most` + 1 truth values if `least` is 0.
std::vector<int> indices(nb::handle object, const std::string &what, long least, long most);
/// Whole numbers in rows and columns; a negative size allows any.
Eigen::MatrixXi whole_matrix(nb::handle object, const std::string &what, Index rows,
                             Index columns, long least, long most);
/// The arrays of a dict with their names, in the order of the dict.
std::vector<std::pair<std::string, nb::object>> by_names(const NamedNumbers &arrays,
                                                         const std::string &what);
/// True if `object` is an array, or can be made one, of truth values.
bool is_mask(nb::handle object);

/// The number of a word among the allowed words; InputError if it is none of them.
std::size_t choice(const std::string &word, const std::string &what,
                   const std::vector<std::string> &words);

/// The enumerators of an enumeration, as Python has them: words.hpp.
template <class Enum>
const std::vector<std::string> &words();

template <class Enum>
Enum chosen(const std::string &word, const std::string &what)
{
   return static_cast<Enum>(choice(word, what, words<Enum>()));
}
template <class Enum>
const std::string &word(Enum value)
{
   return words<Enum>()[static_cast<std::size_t>(value)];
}

} // namespace cattaneo::python
