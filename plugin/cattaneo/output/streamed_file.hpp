#pragma once

#include <cattaneo/input_error.hpp>
#include <fstream>
#include <functional>
#include <string>

namespace cattaneo
{

/// A table cannot be continued, because the disk is full or gone. Rows that were written stay.
class WriteError : public InputError
{
public:
   using InputError::InputError;
};

/** A table that is written as its rows come, a line each, and holds none of them: what was
    added is with the operating system when add() returns, and stays there whatever becomes of
    the program. The first column is a time that does not fall. */
class StreamedFile
{
public:
   /// A new file, in place of an old one of that name. `header`: its first line, without the
   /// end of line. InputError if the file cannot be written.
   StreamedFile(const std::string &file, const std::string &header);
   /** Goes on with the file that a program left behind: lines later than `time`, and one that
       was cut short, are dropped. A new file if there is none. InputError if it has another
       header or cannot be written.
       @param check called with the last line that stays, before anything is dropped: throws if
          this is not the file that is to be gone on with */
   StreamedFile(const std::string &file, const std::string &header, double time,
                const std::function<void(const std::string &)> &check = {});

   /// Whole lines, with their ends. WriteError if they cannot be written.
   void add(const std::string &lines);

private:
   void open();

   std::string file_;
   std::ofstream out_;
};

} // namespace cattaneo
