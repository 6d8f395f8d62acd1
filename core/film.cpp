// film.cpp
