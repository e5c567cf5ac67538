"""Period matrices of surfaces of genus 2 that are known exactly."""

import numpy as np

BOLZA = np.array([[-2, 1], [1, -2]]) / 3 + 1j * np.array([[2, -1], [-1, 2]]) * np.sqrt(2) / 3
BOLZA_AGAIN = np.array([[1, -1], [-1, 1]]) / 2 + 1j * np.eye(2) / np.sqrt(2)
LAWSON = 1j / np.sqrt(3) * np.array([[2, -1], [-1, 2]])
SQUARES = 1j / 3 * np.array([[5, -4], [-4, 5]])
