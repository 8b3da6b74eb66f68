# For Doxygen: links to other files of the repository, as seen from build/docs.
/^!/!s|\[([^]]+)\]\(([^)]+)\)|<a href="../../\2">\1</a>|g
