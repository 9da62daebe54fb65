; A cup from one table to another, nothing in the way: 4 actions.
(define (problem one-cup)
  (:domain kitchen)
  (:objects dock table1 table2 - place cup1 - cup)
  (:init (robot-at dock) (cup-at cup1 table1) (hand-empty) (arm-home) (free table2) (open table1) (open table2))
  (:goal (cup-at cup1 table2)))
