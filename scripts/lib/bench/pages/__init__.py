"""The measured pages. Each module has

- SETTINGS: how much is measured, as name: (value, value of --quick); each is an option of the command line,
- measure(run): the numbers, as rows of a table and what else the page needs,
- write(run, found): the page and its charts, from the numbers alone.

measure() may also draw renders, which cannot be drawn again from numbers. `CSV` names the file of the rows;
everything else is kept as JSON.
"""
