// Defects made on purpose, one for each thing that a sanitizer is to find. Plain C, so that Python calls them as well.
#pragma once

extern "C" {
/// Reads one past the end of an array of the heap. @param length of the array
int heap_overflow(int length);
/// Adds 1. @param number INT_MAX is the defect
int signed_overflow(int number);
/// Forgets some arrays.
void leak();
/// Two threads write the same number without any order.
int data_race();
}
