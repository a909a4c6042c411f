#include "settings.hpp"

namespace cattaneo::python
{

namespace
{

std::string written(nb::handle value)
{
   return nb::repr(value).c_str();
}

} // namespace

SettingsClass::SettingsClass(nb::handle type, std::vector<SettingsMember> members,
                             void *defaults)
   : type_(type), name_(nb::cast<std::string>(type.attr("__name__"))),
     members_(std::move(members))
{
   for (SettingsMember &each : members_)
   {
      each.value = written(each.get(defaults, nb::handle()));
   }
}

const SettingsMember *SettingsClass::find(const std::string &name) const
{
   for (const SettingsMember &each : members_)
   {
      if (each.name == name) { return &each; }
   }
   return nullptr;
}

std::string SettingsClass::unknown(const std::string &name) const
{
   std::string all;
   for (const SettingsMember &each : members_)
   {
      all += (all.empty() ? "'" : ", '") + each.name + "'";
   }
   return name_ + " has no '" + name + "', it has " + all;
}

void *SettingsClass::settings(nb::handle self) const
{
   const bool own =
      PyObject_TypeCheck(self.ptr(), reinterpret_cast<PyTypeObject *>(type_.ptr())) != 0;
   if (!own || !nb::inst_ready(self))
   {
      throw nb::type_error((name_ + ": self is not one that was made").c_str());
   }
   return nb::inst_ptr<void>(self);
}

void SettingsClass::set(void *settings, const nb::dict &values) const
{
   for (const auto &[key, value] : values)
   {
      const auto name = nb::cast<std::string>(key);
      const SettingsMember *member = find(name);
      if (!member) { throw nb::type_error(unknown(name).c_str()); }
      member->set(settings, value);
   }
}

bool SettingsClass::set_any(void *settings, const std::string &name, nb::handle value) const
{
   if (const SettingsMember *member = find(name))
   {
      member->set(settings, value);
      return true;
   }
   for (const SettingsMember &each : members_)
   {
      if (each.set_within(settings, name, value)) { return true; }
   }
   return false;
}

void SettingsClass::set_all(void *settings, const nb::kwargs &values) const
{
   for (const auto &[key, value] : values)
   {
      const auto name = nb::cast<std::string>(key);
      if (!set_any(settings, name, value)) { throw nb::type_error(unknown(name).c_str()); }
   }
}

nb::dict SettingsClass::values(nb::handle self) const
{
   nb::dict all;
   for (const SettingsMember &each : members_)
   {
      all[each.name.c_str()] = each.get(settings(self), self);
   }
   return all;
}

std::string SettingsClass::text(nb::handle self) const
{
   std::string all;
   for (const SettingsMember &each : members_)
   {
      const std::string value = written(each.get(settings(self), self));
      if (value == each.value) { continue; }
      all += (all.empty() ? "" : ", ") + each.name + "=" + value;
   }
   return name_ + "(" + all + ")";
}

std::string SettingsClass::signature() const
{
   std::string all = "def __init__(self, *";
   for (const SettingsMember &each : members_)
   {
      // A stub can contain numbers, words and tuples.
      const bool known =
         each.value != "inf" && (each.value[0] == '(' || each.value.back() != ')');
      all += ", " + each.name + ": " + each.kind + " = " + (known ? each.value : "...");
   }
   return all + ") -> None";
}

void SettingsClass::define(const std::shared_ptr<const SettingsClass> &self) const
{
   const auto method = [&](const char *name, auto function, const auto &...of) {
      nb::cpp_function_def(function, nb::scope(type_), nb::name(name), nb::is_method(), of...);
   };
   const nb::object property = nb::module_::import_("builtins").attr("property");
   for (const SettingsMember &each : members_)
   {
      const auto get = [self, member = &each](nb::handle of)
      { return member->get(self->settings(of), of); };
      const auto set = [self, member = &each](nb::handle of, nb::handle value)
      { member->set(self->settings(of), value); };
      const std::string getter = "def " + each.name + "(self) -> " + each.kind,
                        setter =
                           "def " + each.name + "(self, value: " + each.kind + ", /) -> None";
      type_.attr(each.name.c_str()) = property(
         nb::cpp_function(get, nb::is_method(), nb::is_getter(), nb::sig(getter.c_str()),
                          each.doc.c_str()),
         nb::cpp_function(set, nb::is_method(), nb::sig(setter.c_str())), nb::none(), each.doc);
   }
   method(
      "__setattr__",
      [self](nb::handle of, const std::string &name, nb::handle value)
      {
         const SettingsMember *member = self->find(name);
         if (!member) { throw nb::attribute_error(self->unknown(name).c_str()); }
         member->set(self->settings(of), value);
      },
      arg("name"), arg("value").none());
   method("__getattr__",
          [self](nb::handle, const std::string &name) -> nb::object
          { throw nb::attribute_error(self->unknown(name).c_str()); });
   method("__repr__", [self](nb::handle of) { return self->text(of); });
   method("__getstate__", [self](nb::handle of) { return self->values(of); });
}

} // namespace cattaneo::python
