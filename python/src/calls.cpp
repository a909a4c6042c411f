#include "module.hpp"

#include <string>
#include <unordered_map>

// Calls whose arguments fit no signature: a name that is misspelt, one too many, one too few.
// All parameters take any object, so that nothing else can fail to fit, and nanobind would
// answer with a list of signatures. Here it is one sentence (cattaneo/_calls.py writes it). A
// function of nanobind's is called through a pointer in the object, where CPython's protocol of
// vector calls has it; it is replaced by one that calls what was there and looks at what came
// of it.

namespace cattaneo::python
{

namespace
{

namespace nb = nanobind;

vectorcallfunc &pointer(PyObject *function)
{
   return *reinterpret_cast<vectorcallfunc *>(reinterpret_cast<char *>(function) +
                                              Py_TYPE(function)->tp_vectorcall_offset);
}

/// What was in the place of call(); not written to after the module is made.
std::unordered_map<PyObject *, vectorcallfunc> &originals()
{
   static std::unordered_map<PyObject *, vectorcallfunc> all;
   return all;
}

/// Raises the sentence in the place of a list of signatures.
void explain(PyObject *function, std::size_t by_place, PyObject *names)
{
   nb::python_error error; // takes the error that is raised
   const nb::object kept = nb::borrow(error.value());
   if (std::string(nb::str(kept).c_str()).find("incompatible function arguments") ==
       std::string::npos)
   {
      error.restore();
      return;
   }
   const nb::object named = names != nullptr ? nb::borrow(names) : nb::object(nb::make_tuple());
   const nb::object sentence = nb::module_::import_("cattaneo._calls")
                                  .attr("sentence")(nb::handle(function), by_place, named);
   PyErr_SetObject(PyExc_TypeError, sentence.ptr());
}

PyObject *call(PyObject *function, PyObject *const *arguments, std::size_t flags,
               PyObject *names) noexcept
{
   PyObject *result = originals().find(function)->second(function, arguments, flags, names);
   if (result != nullptr || PyErr_ExceptionMatches(PyExc_TypeError) == 0) { return result; }
   try
   {
      // The highest bits are flags, of CPython and of nanobind.
      explain(function, flags & 0xffffffff, names);
   }
   catch (nb::python_error &error)
   {
      error.restore();
   }
   return nullptr;
}

void watch_calls_of(nb::handle scope)
{
   for (const nb::handle value : nb::list(scope.attr("__dict__").attr("values")()))
   {
      const std::string kind = nb::str(value.type().attr("__name__")).c_str();
      if ((kind == "nb_func" || kind == "nb_method") &&
          originals().emplace(value.ptr(), pointer(value.ptr())).second)
      {
         pointer(value.ptr()) = call;
      }
      else if (PyType_Check(value.ptr()) && nb::type_check(value)) { watch_calls_of(value); }
   }
}

} // namespace

void explain_calls(nb::module_ &m)
{
   watch_calls_of(m);
   for (const nb::handle value : nb::list(m.attr("__dict__").attr("values")()))
   {
      if (PyModule_Check(value.ptr())) { watch_calls_of(value); }
   }
}

} // namespace cattaneo::python
