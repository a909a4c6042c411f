#include "arguments.hpp"

#include <cmath>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

namespace cattaneo::python
{

namespace
{

std::string written(nb::handle object)
{
   const nb::object text = nb::steal(PyObject_Str(object.ptr()));
   if (!text.is_valid()) { throw nb::python_error(); }
   return PyUnicode_AsUTF8(text.ptr());
}

std::string shape_of(nb::handle array)
{
   return written(nb::object(array.attr("shape")));
}

char kind_of(nb::handle array)
{
   return written(nb::object(array.attr("dtype").attr("kind")))[0];
}

std::string article(const std::string &noun)
{
   return (std::string("aeiouAEIOU").find(noun[0]) == std::string::npos ? "a " : "an ") + noun;
}

std::string class_name(nb::handle type)
{
   const std::string name = written(nb::object(type.attr("__name__")));
   return name.substr(name.rfind('.') + 1);
}

std::string described(nb::handle object)
{
   if (object.is_none()) { return "None"; }
   if (nb::isinstance<nb::str>(object)) { return nb::repr(object).c_str(); }
   if (PyLong_Check(object.ptr()) || PyFloat_Check(object.ptr())) { return written(object); }
   if (nb::isinstance<nb::list>(object) || nb::isinstance<nb::tuple>(object))
   {
      return article(class_name(object.type())) + " of " + std::to_string(nb::len(object)) +
             " entries";
   }
   if (class_name(object.type()) == "ndarray")
   {
      return "an array of shape " + shape_of(object);
   }
   return article(class_name(object.type()));
}

/// An array whose entries are of one of the kinds ("iuf", as NumPy names them).
nb::object array_of(nb::handle object, const std::string &what, const std::string &kinds,
                    const std::string &needed)
{
   const nb::module_ numpy = nb::module_::import_("numpy");
   const bool sparse = nb::hasattr(object, "tocsr"),
              masked = nb::isinstance(object, numpy.attr("ma").attr("MaskedArray"));
   if (object.is_none() || nb::isinstance<nb::str>(object) ||
       nb::isinstance<nb::bytes>(object) || nb::isinstance<nb::dict>(object) || sparse ||
       masked || PyCallable_Check(object.ptr()) != 0)
   {
      refuse(object, what, needed);
   }
   nb::object array;
   try
   {
      array = numpy.attr("asarray")(object);
   }
   catch (nb::python_error &error)
   {
      if (!error.matches(PyExc_ValueError) && !error.matches(PyExc_TypeError)) { throw; }
      throw InputError(what + " cannot be made an array, rows may differ in length; must be " +
                       needed);
   }
   const char kind = kind_of(array);
   const bool empty = integer(array.attr("size")) == 0; // [] is of kind f
   if (kinds.find(kind) == std::string::npos && !(empty && kind == 'f'))
   {
      const std::string found = kind == 'O'
                                   ? described(object)
                                   : "of dtype " + written(nb::object(array.attr("dtype")));
      throw nb::type_error((what + " is " + found + ", must be " + needed).c_str());
   }
   return array;
}

/// Doubles in C order, which are kept alive.
struct Doubles
{
   nb::object array;
   const double *data = nullptr;
   std::vector<Index> shape;
};

Doubles doubles(nb::handle object, const std::string &what, const std::string &needed)
{
   const nb::module_ numpy = nb::module_::import_("numpy");
   const nb::object array = array_of(object, what, "iuf", needed);
   Doubles all;
   for (const nb::handle size : array.attr("shape")) { all.shape.push_back(integer(size)); }
   all.array = numpy.attr("ascontiguousarray")(array, numpy.attr("float64"));
   const auto view =
      nb::cast<nb::ndarray<const double, nb::c_contig, nb::device::cpu>>(all.array);
   all.data = view.data();
   return all;
}

std::string entry(const std::string &what, Index i)
{
   return what + "[" + std::to_string(i) + "]";
}

std::string entry(const std::string &what, Index i, Index j)
{
   return what + "[" + std::to_string(i) + ", " + std::to_string(j) + "]";
}

std::string sizes(Index rows, Index columns)
{
   const auto text = [](Index size) { return size < 0 ? "any" : std::to_string(size); };
   if (rows < 0 && columns < 0) { return "two dimensions"; }
   return "(" + text(rows) + ", " + text(columns) + ")";
}

Eigen::VectorXd any_vector(const Doubles &all, nb::handle object, const std::string &what,
                           Index size)
{
   if (all.shape.size() != 1)
   {
      throw InputError(what + " is " + described(object) + ", must be of one dimension" +
                       (size < 0 ? "" : ", with " + std::to_string(size) + " entries"));
   }
   require(size < 0 || all.shape[0] == size, what, " has ", all.shape[0],
           " entries, must have ", size);
   return Eigen::Map<const Eigen::VectorXd>(all.data, all.shape[0]);
}

Eigen::VectorXd finite_vector(const Doubles &all, nb::handle object, const std::string &what,
                              Index size)
{
   Eigen::VectorXd values = any_vector(all, object, what, size);
   for (Index i = 0; i < values.size(); ++i)
   {
      require(std::isfinite(values[i]), entry(what, i), " is ", values[i], ", must be finite");
   }
   return values;
}

} // namespace

Index integer(nb::handle object)
{
   const Py_ssize_t value = PyNumber_AsSsize_t(object.ptr(), PyExc_OverflowError);
   if (value == -1 && PyErr_Occurred() != nullptr) { throw nb::python_error(); }
   return value;
}

void refuse(nb::handle object, const std::string &what, const std::string &needed)
{
   throw nb::type_error((what + " is " + described(object) + ", must be " + needed).c_str());
}

double finite(double value, const char *what)
{
   require(std::isfinite(value), what, " is ", value, ", must be finite");
   return value;
}

int within(int value, const char *what, int least, int most)
{
   require(value >= least && value <= most, what, " is ", value, ", must be from ", least,
           " to ", most);
   return value;
}

double number(nb::handle object, const std::string &what)
{
   const Doubles one = doubles(object, what, "a number");
   if (!one.shape.empty()) { refuse(object, what, "a number"); }
   return finite(one.data[0], what.c_str());
}

std::string file(nb::handle object, const std::string &what)
{
   nb::object path = nb::borrow(object);
   if (nb::hasattr(object, "__fspath__")) { path = object.attr("__fspath__")(); }
   std::string name;
   if (!nb::isinstance<nb::str>(path)) { refuse(path, what, "a str or a path"); }
   require(nb::try_cast(path, name) && !name.empty() && name.find('\0') == std::string::npos,
           what, " is ", described(path), ", must be the name of a file");
   return name;
}

std::size_t choice(const std::string &word, const std::string &what,
                   const std::vector<std::string> &words)
{
   std::string all;
   for (std::size_t k = 0; k < words.size(); ++k)
   {
      if (word == words[k]) { return k; }
      all += (k == 0 ? "'" : ", '") + words[k] + "'";
   }
   throw InputError(what + " is '" + word + "', must be one of " + all);
}

Eigen::VectorXd vector(nb::handle object, const std::string &what, Index size)
{
   return finite_vector(doubles(object, what, "numbers"), object, what, size);
}

Eigen::VectorXd vector_or_number(nb::handle object, const std::string &what, Index size)
{
   const Doubles all = doubles(object, what, "a number or an array of them");
   if (!all.shape.empty()) { return finite_vector(all, object, what, size); }
   require(std::isfinite(all.data[0]), what, " is ", all.data[0], ", must be finite");
   return Eigen::VectorXd::Constant(size, all.data[0]);
}

Eigen::VectorXd bounds(nb::handle object, const std::string &what, Index size)
{
   const Doubles all = doubles(object, what, "a number or an array of them");
   const Eigen::VectorXd values =
      all.shape.empty() ? Eigen::VectorXd(Eigen::VectorXd::Constant(size, all.data[0]))
                        : any_vector(all, object, what, size);
   for (Index i = 0; i < values.size(); ++i)
   {
      require(!std::isnan(values[i]), entry(what, i), " is nan, must be a number");
   }
   return values;
}

Eigen::MatrixXd matrix(nb::handle object, const std::string &what, Index rows, Index columns)
{
   const Doubles all = doubles(object, what, "numbers in rows and columns");
   require(all.shape.size() == 2 && (rows < 0 || all.shape[0] == rows) &&
              (columns < 0 || all.shape[1] == columns),
           what, " has shape ", shape_of(all.array), ", must have ", sizes(rows, columns));
   using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
   const Eigen::Map<const Rows> values(all.data, all.shape[0], all.shape[1]);
   for (Index i = 0; i < values.rows(); ++i)
   {
      for (Index j = 0; j < values.cols(); ++j)
      {
         require(std::isfinite(values(i, j)), entry(what, i, j), " is ", values(i, j),
                 ", must be finite");
      }
   }
   return values;
}

bool is_mask(nb::handle object)
{
   return kind_of(nb::module_::import_("numpy").attr("asarray")(object)) == 'b';
}

std::vector<int> indices(nb::handle object, const std::string &what, long least, long most)
{
   const nb::object array = array_of(object, what, "iub", "whole numbers, or a mask");
   const nb::module_ numpy = nb::module_::import_("numpy");
   if (kind_of(array) == 'b')
   {
      const nb::object size = array.attr("shape");
      require(nb::len(size) == 1 && integer(size[0]) == most + 1 && least == 0, what,
              " is a mask of shape ", shape_of(array), ", must have ", most + 1, " entries");
      return indices(numpy.attr("flatnonzero")(array), what, 0, most);
   }
   const nb::object one = numpy.attr("atleast_1d")(array);
   require(nb::len(nb::object(one.attr("shape"))) == 1, what, " has shape ", shape_of(one),
           ", must be of one dimension");
   const nb::object column = one.attr("reshape")(-1, 1);
   const Eigen::MatrixXi all = whole_matrix(column, what, -1, 1, least, most);
   return {all.data(), all.data() + all.size()};
}

std::vector<std::pair<std::string, nb::object>> by_names(const NamedNumbers &arrays,
                                                         const std::string &what)
{
   std::vector<std::pair<std::string, nb::object>> all;
   for (const auto &[key, value] : nb::borrow<nb::dict>(arrays))
   {
      std::string name;
      if (!nb::try_cast(key, name)) { refuse(key, "a name in " + what, "a str"); }
      all.emplace_back(name, nb::borrow(value));
   }
   return all;
}

Eigen::MatrixXi whole_matrix(nb::handle object, const std::string &what, Index rows,
                             Index columns, long least, long most)
{
   const nb::object array = array_of(object, what, "iu", "whole numbers");
   const nb::module_ numpy = nb::module_::import_("numpy");
   require(nb::len(nb::object(array.attr("shape"))) == 2, what, " has shape ", shape_of(array),
           ", must have ", sizes(rows, columns));
   const Index height = integer(array.attr("shape")[0]),
               width = integer(array.attr("shape")[1]);
   require((rows < 0 || height == rows) && (columns < 0 || width == columns), what,
           " has shape ", shape_of(array), ", must have ", sizes(rows, columns));
   // As doubles, whole numbers do not wrap around. A number that is too large for a double is
   // out of range too.
   const nb::object exact = numpy.attr("ascontiguousarray")(array, numpy.attr("float64"));
   const auto view = nb::cast<nb::ndarray<const double, nb::c_contig, nb::device::cpu>>(exact);
   Eigen::MatrixXi all(height, width);
   for (Index i = 0; i < height; ++i)
   {
      for (Index j = 0; j < width; ++j)
      {
         const double value = view.data()[i * width + j];
         require(value >= static_cast<double>(least) && value <= static_cast<double>(most),
                 width == 1 ? entry(what, i) : entry(what, i, j), " is ", value,
                 ", must be from ", least, " to ", most);
         all(i, j) = static_cast<int>(value);
      }
   }
   return all;
}

} // namespace cattaneo::python
