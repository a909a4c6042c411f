#pragma once

#include "arguments.hpp"
#include "words.hpp"
#include <cattaneo/readout/edge_fit.hpp>
#include <functional>
#include <memory>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

// Structs of settings as classes of Python's. Their members and what is said of them are those
// of the C++ struct: settings.py reads them from its header, and writes for each a header with
// a specialisation of bind_settings().

namespace cattaneo::python
{

/// Adds the class of a struct of settings to a module.
template <class T>
void bind_settings(nb::module_ &m);

/// A member as Python has it: how its kind is called, and how it is read and set. Settings
/// within settings are no copies where `owner` is the object that has them.
template <class Value>
struct Kind
{
   static std::string name()
   {
      if constexpr (std::is_enum_v<Value>) { return "typing.Literal[" + quoted() + "]"; }
      else if constexpr (nb::detail::is_base_caster_v<nb::detail::make_caster<Value>>)
      {
         const nb::handle type = nb::type<Value>();
         return nb::cast<std::string>(type.attr("__module__")) + "." +
                nb::cast<std::string>(type.attr("__qualname__"));
      }
      else if constexpr (std::is_same_v<Value, std::vector<int>>)
      {
         return "collections.abc.Sequence[int]";
      }
      else { return nb::detail::make_caster<Value>::Name.text; }
   }
   /// As sentences say it.
   static std::string needed()
   {
      if constexpr (std::is_enum_v<Value>) { return "one of " + quoted(); }
      else { return name(); }
   }
   static nb::object get(Value &value, nb::handle owner)
   {
      if constexpr (std::is_enum_v<Value>) { return nb::cast(word(value)); }
      else if constexpr (std::is_same_v<Value, std::vector<int>>)
      {
         return nb::tuple(nb::cast(value)); // a list would be changed in vain
      }
      else if (owner.is_valid())
      {
         return nb::cast(value, nb::rv_policy::reference_internal, owner);
      }
      else { return nb::cast(value); }
   }
   /// False if `from` is of another kind.
   static bool set(nb::handle from, Value &value, const std::string &what)
   {
      if constexpr (std::is_enum_v<Value>)
      {
         std::string text;
         if (!nb::try_cast(from, text)) { return false; }
         value = chosen<Value>(text, what);
         return true;
      }
      else if constexpr (std::is_same_v<Value, bool>)
      {
         const std::string kind = nb::inst_name(from).c_str(); // NumPy has truth values, too
         value = PyObject_IsTrue(from.ptr()) == 1;
         return kind == "bool" || kind == "numpy.bool" || kind == "numpy.bool_";
      }
      else { return nb::try_cast(from, value); }
   }

private:
   static std::string quoted()
   {
      std::string all;
      for (const std::string &each : words<Value>())
      {
         all += (all.empty() ? "'" : ", '") + each + "'";
      }
      return all;
   }
};
/// Distances from an edge, (nearest, farthest), or None where the window is chosen.
template <>
struct Kind<FitWindow>
{
   using Window = std::optional<std::pair<double, double>>;

   static std::string name() { return "tuple[float, float] | None"; }
   static std::string needed() { return "two distances, or None"; }
   static nb::object get(const FitWindow &value, nb::handle)
   {
      const bool chosen = value.nearest == 0 && value.farthest == 0;
      return nb::cast(chosen ? Window() : Window({value.nearest, value.farthest}));
   }
   static bool set(nb::handle from, FitWindow &value, const std::string &)
   {
      Window window;
      if (!nb::try_cast(from, window)) { return false; }
      value = window ? FitWindow{window->first, window->second} : FitWindow{};
      return true;
   }
};

/// What all classes of settings do with the members that they have.
class SettingsClass
{
public:
   using Setter = std::function<void(void *settings, nb::handle value)>;

   SettingsClass(std::string name) : name_(std::move(name)) {}
   void add(std::string member, std::string kind, nb::handle value, Setter setter);
   /// TypeError for a name that no member has.
   void set(void *settings, nb::kwargs values) const;
   /// AttributeError for such a name.
   void require_member(const std::string &name) const;
   nb::dict values(nb::handle settings) const;
   /// Members that differ from the defaults, as they are given to the class.
   std::string text(nb::handle settings) const;
   /// Of its constructor.
   std::string signature() const;
   const std::string &name() const { return name_; }

private:
   struct Member
   {
      std::string name, kind, value;
      Setter set;
   };
   std::string unknown(const std::string &name) const;

   std::string name_;
   std::vector<Member> members_;
};

template <class T>
class Settings
{
public:
   Settings(nb::module_ &m, const char *name, const char *doc)
      : class_(m, name, doc), all_(std::make_shared<SettingsClass>(name))
   {
   }

   template <class Value>
   Settings &member(const char *name, Value T::*member, const char *doc)
   {
      const std::string what = all_->name() + "." + name, kind = Kind<Value>::name(),
                        needed = Kind<Value>::needed();
      // Changes a copy, which is checked before it is taken.
      const auto set = [member, what, needed](T &settings, nb::handle value)
      {
         T changed = settings;
         if (!Kind<Value>::set(value, changed.*member, what)) { refuse(value, what, needed); }
         check(changed, 0);
         settings = std::move(changed);
      };
      const auto get = [member](T &settings)
      { return Kind<Value>::get(settings.*member, nb::find(settings)); };
      const std::string getter = std::string("def ") + name + "(self) -> " + kind,
                        setter = std::string("def ") + name + "(self, value: " + kind +
                                 ", /) -> None";
      class_.def_prop_rw(
         name, get, [set](T &settings, nb::object value) { set(settings, value); },
         nb::for_getter(nb::sig(getter.c_str())), nb::for_setter(nb::sig(setter.c_str())),
         nb::for_setter(arg("value").none()), doc);
      T defaults;
      all_->add(name, kind, Kind<Value>::get(defaults.*member, nb::handle()),
                [set](void *settings, nb::handle value)
                { set(*static_cast<T *>(settings), value); });
      return *this;
   }

   /// After all members.
   void done()
   {
      const auto made = [all = all_](T *self, nb::kwargs values)
      {
         T settings;
         all->set(&settings, values);
         new (self) T(std::move(settings));
      };
      const std::string signature = all_->signature();
      class_.def("__init__", made, nb::sig(signature.c_str()))
         .def(
            "__setattr__",
            [all = all_](nb::handle_t<T> self, const std::string &name, nb::object value)
            {
               all->require_member(name);
               const nb::object key = nb::cast(name);
               if (PyObject_GenericSetAttr(self.ptr(), key.ptr(), value.ptr()) != 0)
               {
                  throw nb::python_error();
               }
            },
            arg("name"), arg("value").none())
         .def("__getattr__", [all = all_](nb::handle_t<T>, const std::string &name)
              { all->require_member(name); })
         .def("__repr__", [all = all_](nb::handle_t<T> self) { return all->text(self); })
         .def("__getstate__", [all = all_](nb::handle_t<T> self) { return all->values(self); })
         .def("__setstate__",
              [made](T *self, nb::dict values) { made(self, nb::borrow<nb::kwargs>(values)); });
   }

private:
   /// The check that the C++ library makes, if there is one of this struct alone.
   template <class Struct>
   static auto check(const Struct &settings, int) -> decltype(settings.validate())
   {
      settings.validate();
   }
   template <class Struct>
   static void check(const Struct &, long)
   {
   }

   nb::class_<T> class_;
   std::shared_ptr<SettingsClass> all_;
};

} // namespace cattaneo::python
