#include "module.hpp"

#include "watch.hpp"
#include <cattaneo/algebra/blas_kernels.hpp>
#include <cattaneo/counters.hpp>
#include <cattaneo/version.hpp>
#include <nanobind/stl/string.h>

namespace nb = nanobind;
using namespace cattaneo;

namespace
{

void bind_common(nb::module_ &m)
{
   static const nb::object input_error =
      nb::steal(PyErr_NewExceptionWithDoc("cattaneo._core.InputError",
                                          "Bad input. The message is one sentence: what is "
                                          "wrong, where, the value, and what is allowed.",
                                          PyExc_ValueError, nullptr));
   m.attr("InputError") = input_error;
   // A sentence may quote a file that is not in UTF-8.
   nb::register_exception_translator(
      [](const std::exception_ptr &thrown, void *)
      {
         try
         {
            std::rethrow_exception(thrown);
         }
         catch (const InputError &error)
         {
            const std::string text = error.what();
            const nb::object sentence = nb::steal(PyUnicode_DecodeUTF8(
               text.data(), static_cast<Py_ssize_t>(text.size()), "replace"));
            PyErr_SetObject(input_error.ptr(), sentence.ptr());
         }
      });
   m.attr("OutcomeWarning") = nb::steal(PyErr_NewExceptionWithDoc(
      "cattaneo._core.OutcomeWarning",
      "A warning of an outcome that a script should not ignore: a march that did not converge, "
      "or a limit that is not proven. `status` and `message` of the report tell the same.",
      PyExc_RuntimeWarning, nullptr));

   nb::class_<Progress>(m, "Progress", "Progress of long work.")
      .def_ro("share", &Progress::share,
              "share of the work that is done, 0 to 1; nan: not known")
      .def_ro("steps", &Progress::steps, "increments of a march, iterations of a limit")
      .def_ro("time", &Progress::time, "of a march, in its load history")
      .def_ro("seconds", &Progress::seconds, "since it began");
   nb::class_<BlasKernels>(m, "BlasKernels", "The kernels of OpenBLAS that this process uses.")
      .def_ro("name", &BlasKernels::name,
              "OpenBLAS's own name, as 'Haswell'; '' with another BLAS or with none")
      .def_ro("better", &BlasKernels::better,
              "name of safe kernels that are far faster on this processor; '': there are none")
      .def_prop_ro("statement", &BlasKernels::statement,
                   "one sentence with their name; it says what to do if others are far faster")
      .def("__repr__", &BlasKernels::statement);
   m.def("blas_kernels", &blas_kernels,
         "The kernels of OpenBLAS that this process uses. OpenBLAS chooses them when it is "
         "loaded, by the name of the processor. The environment variable OPENBLAS_CORETYPE, "
         "set before Python starts, chooses others.");
   nb::class_<Counters> counters(
      m, "Counters", "How often each expensive operation was done: dict(counters).");
   counters.def(
      "keys",
      [](const Counters &self)
      {
         nb::list names;
         Counters::for_each(self, [&](const char *name, long) { names.append(name); });
         return names;
      },
      nb::sig("def keys(self) -> list[str]"), "Names of the operations.");
   counters.def("__getitem__",
                [](const Counters &self, const std::string &name)
                {
                   long found = -1;
                   Counters::for_each(self, [&](const char *each, long value)
                                      { found = each == name ? value : found; });
                   if (found < 0) { throw nb::key_error(name.c_str()); }
                   return found;
                });
   counters.def(
      "__repr__", [](nb::handle self)
      { return nb::repr(nb::handle(reinterpret_cast<PyObject *>(&PyDict_Type))(self)); });
}

} // namespace

NB_MODULE(_core, m)
{
   // Objects of the module live longer than the interpreter's check for leaks.
   nb::set_leak_warnings(false);
   m.doc() = "Cattaneo::core as Python sees it; the package cattaneo has the names.";
   m.attr("version") = CATTANEO_VERSION;
   bind_common(m);
   python::bind_bodies(m);
   python::bind_reduced_problems(m);
   python::bind_half_planes(m);
   python::bind_half_spaces(m);
   python::bind_reductions(m);
   python::bind_states(m);
   python::bind_marches(m);
   python::bind_readout(m);
   python::bind_areas(m);
   python::bind_shakedown(m);
   python::bind_fretting(m);
   python::bind_wear(m);
   python::bind_design(m);
   python::bind_joints(m);
}
